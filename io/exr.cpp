#include "io/exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/report.h"
#include "spectral/colorimetry.h"

namespace lucerna::io {
namespace {

// OpenEXR writes through this, so that each error of the disk is seen.
class AtomicStream : public Imf::OStream {
public:
    explicit AtomicStream(AtomicFile& file) : OStream(file.path().c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        file_.write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }

private:
    AtomicFile& file_;
};

std::size_t pixel_count(const optics::Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

// Named planes of one image on their way into a file.
class Planes {
public:
    Planes(const optics::Image& image, const Provenance& provenance)
        : image_(image), header_(image.width, image.height) {
        header_.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header_, Imf::Chromaticities());  // BT.709 and D65 by default
        Imf::addWhiteLuminance(header_, 1.0F);                   // R = G = B = 1 is 1 cd/m2
        header_.insert("phases", Imf::IntAttribute(static_cast<int>(provenance.phases)));
        header_.insert("seed",
                       Imf::StringAttribute(fmt::format("{}", fmt::join(provenance.seeds, " "))));
        header_.insert("sceneHash", Imf::StringAttribute(provenance.scene_hash));
        header_.insert("software", Imf::StringAttribute("Lucerna " LUCERNA_VERSION));
        add_rgb();
    }

    Imf::Header& header() { return header_; }

    /// Adds a channel with value(pixel) for each pixel.
    template <typename Value>
    void add(const std::string& name, Value value) {
        std::vector<float>& plane = planes_.emplace_back(pixel_count(image_));
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(value(i));
        header_.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame_.insert(name,
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                 sizeof(float) * static_cast<std::size_t>(image_.width)));
    }

    void write(const std::filesystem::path& path) {
        AtomicFile file(path);
        {
            AtomicStream stream(file);
            Imf::OutputFile output(stream, header_);
            output.setFrameBuffer(frame_);
            output.writePixels(image_.height);
        }  // the end of OutputFile writes the table of lines
        file.commit();
    }

private:
    void add_rgb() {
        for (int c = 0; c < 3; ++c) {
            const Vec3 weights = spectral::linear_srgb_from_xyz().row(c);
            add(std::string(1, "RGB"[c]), [&](std::size_t i) {
                return weights.dot(
                    Vec3(double{image_.x[i]}, image_.pixel(i).value, double{image_.z[i]}));
            });
        }
    }

    const optics::Image& image_;
    Imf::Header header_;
    Imf::FrameBuffer frame_;
    std::vector<std::vector<float>> planes_;
};

// "S0.550,000000nm": six decimals, as std::to_string, with the comma that the layout demands.
std::string spectral_channel(double wavelength_nm) {
    std::string number = fmt::format("{:.6f}", wavelength_nm);
    number[number.find('.')] = ',';
    return "S0." + number + "nm";
}

// The values of one channel, top row first.
std::vector<float> read_channel(Imf::InputFile& file, const std::string& name) {
    const Imath::Box2i window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::vector<float> values(width * height);
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return values;
}

// What write_exr says about the errors of an image, as far as the file has it.
void read_errors(Imf::InputFile& file, LuminanceImage& image) {
    const Imf::Header& header = file.header();
    if (header.channels().findChannel("luminance.standard_error") == nullptr) return;
    const std::vector<float> errors = read_channel(file, "luminance.standard_error");
    image.standard_error.assign(errors.begin(), errors.end());
    if (const auto* phases = header.findTypedAttribute<Imf::IntAttribute>("phases")) {
        image.phases = static_cast<std::uint32_t>(std::max(0, phases->value()));
    }
    if (const auto* error = header.findTypedAttribute<Imf::DoubleAttribute>("meanStandardError")) {
        image.mean_standard_error = error->value();
    }
    const auto* tile_size = header.findTypedAttribute<Imf::IntAttribute>("tileSize");
    const auto* tiles = header.findTypedAttribute<Imf::FloatVectorAttribute>("tileStandardError");
    constexpr int size = optics::Image::tile_size;
    const auto count = static_cast<std::size_t>((image.width + size - 1) / size) *
                       static_cast<std::size_t>((image.height + size - 1) / size);
    if (tile_size != nullptr && tile_size->value() == size && tiles != nullptr &&
        tiles->value().size() == count) {
        image.tile_standard_error.assign(tiles->value().begin(), tiles->value().end());
    }
}

LuminanceImage read(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& message) {
        throw InputError({path.string()}, message);
    };
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    const Imf::ChannelList& channels = header.channels();
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    const Imath::Box2i window = header.dataWindow();
    LuminanceImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    if (long{image.width} * image.height > max_pixels) {
        fail(fmt::format("has {} x {} pixels; at most {} are read", image.width, image.height,
                         max_pixels));
    }

    std::array<std::string, 3> names = {"R", "G", "B"};
    Vec3 weights = luminance_of_rgb();
    if (has("luminance.Y") || has("Y")) {
        names = {has("luminance.Y") ? "luminance.Y" : "Y", "", ""};
        weights = {1.0, 0.0, 0.0};
    } else if (!has("R") || !has("G") || !has("B")) {
        fail("has no luminance; expected a channel luminance.Y or Y, or R, G and B");
    } else if (Imf::hasWhiteLuminance(header)) {
        weights *= double{Imf::whiteLuminance(header)};
    }

    image.luminance.resize(static_cast<std::size_t>(image.width) *
                           static_cast<std::size_t>(image.height));
    for (int c = 0; c < 3 && !names[c].empty(); ++c) {
        const Imf::Channel& channel = *channels.findChannel(names[c]);
        if (channel.xSampling != 1 || channel.ySampling != 1)
            fail("has subsampled channels; expected full ones");
        const std::vector<float> values = read_channel(file, names[c]);
        for (std::size_t i = 0; i < values.size(); ++i)
            image.luminance[i] += weights[c] * double{values[i]};
    }
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        if (!std::isfinite(image.luminance[i])) {
            const auto width = static_cast<std::size_t>(image.width);
            fail(fmt::format("has no finite value at pixel [{}, {}]", i % width, i / width));
        }
    }
    if (names[0] == "luminance.Y") read_errors(file, image);
    return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const optics::Image& image,
               const Provenance& provenance) {
    Planes planes(image, provenance);
    const auto estimate = [&](std::size_t i) -> const Estimate& { return image.luminance[i]; };
    planes.add("luminance.Y",
               [&](std::size_t i) { return estimate(i).value(image.corrected_share(i)); });
    planes.add("luminance.standard_error",
               [&](std::size_t i) { return estimate(i).standard_error(image.corrected_share(i)); });
    planes.add("luminance.bias", [&](std::size_t i) { return estimate(i).bias(); });
    planes.add("luminance.correction",
               [&](std::size_t i) { return -image.corrected_share(i) * estimate(i).bias(); });
    const double degrees = image.mean.degrees_of_freedom();
    const double t = degrees >= 1.0 ? student_t(report_coverage, degrees) : infinity;
    planes.add("luminance.expanded_uncertainty", [&](std::size_t i) {
        const double error = image.pixel(i).standard_error;
        return error > 0.0 ? t * error : 0.0;
    });
    std::vector<float> tile_errors;
    for (const Estimate& tile : image.tiles)
        tile_errors.push_back(static_cast<float>(tile.standard_error()));
    Imf::Header& header = planes.header();
    header.insert("units", Imf::StringAttribute("cd/m2"));
    header.insert("delta", Imf::DoubleAttribute(image.delta));
    header.insert("coverage", Imf::DoubleAttribute(report_coverage));
    header.insert("meanStandardError", Imf::DoubleAttribute(image.mean.standard_error()));
    header.insert("tileSize", Imf::IntAttribute(optics::Image::tile_size));
    header.insert("tileStandardError", Imf::FloatVectorAttribute(tile_errors));
    planes.write(path);
}

void write_spectral_exr(const std::filesystem::path& path, const optics::Image& image,
                        const Provenance& provenance) {
    const std::vector<double>& edges_nm = image.bin_edges_nm;
    if (edges_nm.size() < 2) throw std::invalid_argument("the image holds no spectra");
    const std::size_t bins = edges_nm.size() - 1;

    Planes planes(image, provenance);
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const double width_nm = edges_nm[bin + 1] - edges_nm[bin];
        planes.add(spectral_channel(0.5 * (edges_nm[bin] + edges_nm[bin + 1])), [&](std::size_t i) {
            return double{image.spectral_radiance[i * bins + bin]} * width_nm;
        });
    }
    Imf::Header& header = planes.header();
    header.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
    header.insert("emissiveUnits", Imf::StringAttribute("W.m^-2.sr^-1"));
    header.insert("spectralQuantity", Imf::StringAttribute("radiance per bin"));
    header.insert("binEdges_nm", Imf::FloatVectorAttribute({edges_nm.begin(), edges_nm.end()}));
    planes.write(path);
}

LuminanceImage read_exr(const std::filesystem::path& path) {
    try {
        return read(path);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {  // OpenEXR throws types of its own, all of this base
        throw InputError({path.string()},
                         fmt::format("cannot be read as OpenEXR: {}", error.what()));
    }
}

}  // namespace lucerna::io
