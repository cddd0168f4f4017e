#include "optics/scene.h"

namespace lucerna::optics {
namespace {

template <typename Item>
std::uint32_t append(std::vector<Item>& list, Item item) {
    list.push_back(std::move(item));
    return static_cast<std::uint32_t>(list.size() - 1);
}

}  // namespace

SpectrumId SceneParts::add(spectral::Spectrum spectrum) {
    return append(spectra, std::move(spectrum));
}
BsdfId SceneParts::add(Bsdf bsdf) {
    return append(bsdfs, std::move(bsdf));
}
MediumId SceneParts::add(Medium medium) {
    return append(media, std::move(medium));
}
ObjectId SceneParts::add(Object object) {
    return append(objects, std::move(object));
}

}  // namespace lucerna::optics
