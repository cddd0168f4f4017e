#include "spectral/observer.h"

#include "spectral/cie_tables.h"

namespace lucerna::spectral {

const Spectrum& x_bar() {
    static const Spectrum table = cie_column("cie1931_2deg_cmf_1nm", "xbar", Outside::zero);
    return table;
}

const Spectrum& z_bar() {
    static const Spectrum table = cie_column("cie1931_2deg_cmf_1nm", "zbar", Outside::zero);
    return table;
}

const Spectrum& v_lambda() {
    static const Spectrum table = cie_column("cie1924_V_1nm", "V", Outside::zero);
    return table;
}

}  // namespace lucerna::spectral
