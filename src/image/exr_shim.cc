/* exr_shim.cc - see exr_shim.h. In C++, since OpenEXR's C interface cannot decode DWA. The library's global
 * settings (threads, largest sizes) belong to the program and are not changed. */
#include "image/exr_shim.h"

#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <strings.h>

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <half.h>

extern "C" {
#include "base/memory.h"
}

namespace
{

const char *const STREAM_NAME = "memory";

/* ---- streams ---- */

class memory_input : public Imf::IStream
{
  public:
    memory_input(const unsigned char *bytes, size_t size)
        : IStream(STREAM_NAME), bytes_(bytes), size_(size), at_(0)
    {
    }
    bool read(char out[], int count) override
    {
        if (count < 0 || at_ > size_ || static_cast<size_t>(count) > size_ - at_)
            throw Iex::InputExc("the file ends too early");
        std::memcpy(out, bytes_ + at_, static_cast<size_t>(count));
        at_ += static_cast<size_t>(count);
        return at_ < size_;
    }
    uint64_t tellg() override
    {
        return at_;
    }
    void seekg(uint64_t position) override
    {
        at_ = position;
    }

  private:
    const unsigned char *bytes_;
    uint64_t size_, at_;
};

class memory_output : public Imf::OStream
{
  public:
    explicit memory_output(const facet_allocator *allocator) : OStream(STREAM_NAME), allocator_(allocator)
    {
    }
    ~memory_output() override
    {
        mem_free(block_);
    }
    void write(const char bytes[], int count) override
    {
        const size_t end = at_ + static_cast<size_t>(count);
        if (!mem_reserve(allocator_, &block_, &capacity_, end, 1))
            throw std::bad_alloc();
        std::memcpy(static_cast<char *>(block_) + at_, bytes, static_cast<size_t>(count));
        at_ = end;
        size_ = size_ > end ? size_ : end;
    }
    uint64_t tellp() override
    {
        return at_;
    }
    void seekp(uint64_t position) override
    {
        at_ = position;
    }
    unsigned char *take(size_t *size)
    {
        void *block = block_;
        block_ = nullptr;
        *size = size_;
        return static_cast<unsigned char *>(block);
    }

  private:
    const facet_allocator *allocator_;
    void *block_ = nullptr;
    size_t capacity_ = 0, size_ = 0, at_ = 0;
};

/* ---- failures ---- */

facet_result report(char *message, facet_result result, const char *text)
{
    std::snprintf(message, EXR_MESSAGE, "%s", text);
    return result;
}

/* Result of the exception being handled. Must be called in a catch block. */
facet_result report_exception(char *message, facet_result result)
{
    try {
        throw;
    } catch (const std::bad_alloc &) {
        return report(message, FACET_ERROR_MEMORY, "out of memory");
    } catch (const std::exception &e) {
        /* of "Cannot read image file "memory". REASON" only the reason is useful */
        const std::string prefix = std::string("file \"") + STREAM_NAME + "\". ";
        const char *text = e.what();
        const char *found = std::strstr(text, prefix.c_str());
        return report(message, result, found ? found + prefix.size() : text);
    } catch (...) {
        return report(message, result, "the library failed");
    }
}

/* ---- channels of the image ---- */

using channel_iterator = Imf::ChannelList::ConstIterator;

/* The channel named prefix + suffix, ignoring the case of suffix. */
channel_iterator find_channel(const Imf::ChannelList &list, const std::string &prefix, const char *suffix)
{
    channel_iterator c = list.begin();
    while (c != list.end() && (std::strncmp(c.name(), prefix.c_str(), prefix.size()) != 0 ||
                               strcasecmp(c.name() + prefix.size(), suffix) != 0))
        ++c;
    return c;
}

facet_result set_source(const channel_iterator &c, exr_source *source, char *message)
{
    std::snprintf(source->name, EXR_NAME, "%s", c.name());
    source->is_half = c.channel().type == Imf::HALF;
    if (c.channel().xSampling == 1 && c.channel().ySampling == 1)
        return FACET_OK;
    std::snprintf(message, EXR_MESSAGE, "channel %s is not sampled at every texel", c.name());
    return FACET_ERROR_UNSUPPORTED;
}

/* R, G, B and optionally A of the layer prefix. *is_there: R, G and B exist. */
facet_result choose_rgb(const Imf::ChannelList &list, const std::string &prefix, exr_info *info,
                        bool *is_there, char *message)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    facet_result result = FACET_OK;
    info->channel_count = 3;
    *is_there = true;
    for (int k = 0; k < 4; k++) {
        const channel_iterator c = find_channel(list, prefix, names[k]);
        if (c == list.end()) {
            *is_there = *is_there && k == 3;
            continue;
        }
        info->channel_count = k == 3 ? 4 : 3;
        if (result == FACET_OK)
            result = set_source(c, &info->sources[k], message);
    }
    return *is_there ? result : FACET_OK;
}

/* In this order: R, G, B; Y; R, G, B of the first layer that has them; the only channel. */
facet_result choose_channels(const Imf::ChannelList &list, exr_info *info, char *message)
{
    bool is_there;
    facet_result result = choose_rgb(list, "", info, &is_there, message);
    if (is_there)
        return result;
    size_t count = 0;
    for (channel_iterator c = list.begin(); c != list.end(); ++c)
        count++;
    if (count == 0)
        return report(message, FACET_ERROR_INVALID, "there are no channels");
    channel_iterator grey = find_channel(list, "", "Y");
    if (grey == list.end() && count == 1)
        grey = list.begin();
    if (grey != list.end()) {
        if (find_channel(list, "", "RY") != list.end())
            return report(message, FACET_ERROR_UNSUPPORTED, "luminance and chroma (Y, RY, BY) are not read");
        const channel_iterator alpha = find_channel(list, "", "A");
        result = set_source(grey, &info->sources[0], message);
        info->sources[1] = info->sources[2] = info->sources[0];
        info->channel_count = alpha == list.end() || alpha == grey ? 3 : 4;
        return result == FACET_OK && info->channel_count == 4 ? set_source(alpha, &info->sources[3], message)
                                                              : result;
    }
    for (channel_iterator c = list.begin(); c != list.end(); ++c) {
        const char *point = std::strrchr(c.name(), '.');
        if (!point || strcasecmp(point, ".R") != 0)
            continue;
        result = choose_rgb(list, std::string(c.name(), point + 1), info, &is_there, message);
        if (is_there)
            return result;
    }
    std::snprintf(message, EXR_MESSAGE, "none of %zu channels is named R, G, B or Y", count);
    return FACET_ERROR_UNSUPPORTED;
}

/* Order of a channel in its layer by its suffix; unknown suffixes come last. */
int place_of(const char *suffix)
{
    static const char places[] = "RGBAXYZUV";
    const char *found = suffix[0] && !suffix[1] ? std::strchr(places, suffix[0]) : nullptr;
    return found ? static_cast<int>(found - places) : static_cast<int>(sizeof places);
}

/* Names of the layers, such as "albedo, normal, Z". */
facet_result report_layers(const Imf::ChannelList &list, const char *layer, char *message)
{
    std::string names, last;
    for (channel_iterator c = list.begin(); c != list.end(); ++c) {
        const char *point = std::strrchr(c.name(), '.');
        const std::string name = point ? std::string(c.name(), point) : std::string(c.name());
        if (name != last)
            names += (names.empty() ? "" : ", ") + name;
        last = name;
    }
    std::snprintf(message, EXR_MESSAGE, "there is no layer \"%.60s\"; it has %.300s", layer, names.c_str());
    return FACET_ERROR_INVALID;
}

facet_result choose_layer(const Imf::ChannelList &list, const char *layer, exr_info *info, char *message)
{
    const std::string prefix = std::string(layer) + ".";
    facet_result result = FACET_OK;
    int places[4];
    info->channel_count = 0;
    for (channel_iterator c = list.begin(); c != list.end() && result == FACET_OK; ++c) {
        const char *suffix = c.name() + prefix.size();
        const bool is_whole = std::strcmp(c.name(), layer) == 0 ||
                              (std::strcmp(layer, "depth") == 0 && std::strcmp(c.name(), "Z") == 0);
        const bool is_part =
            std::strncmp(c.name(), prefix.c_str(), prefix.size()) == 0 && !std::strchr(suffix, '.');
        if (!is_whole && !is_part)
            continue;
        if (info->channel_count == 4)
            return report(message, FACET_ERROR_UNSUPPORTED, "the layer has more than 4 channels");
        const int place = is_whole ? 0 : place_of(suffix);
        uint32_t k = info->channel_count++;
        for (; k > 0 && places[k - 1] > place; k--) {
            places[k] = places[k - 1];
            info->sources[k] = info->sources[k - 1];
        }
        places[k] = place;
        result = set_source(c, &info->sources[k], message);
    }
    if (result == FACET_OK && info->channel_count == 0)
        return report_layers(list, layer, message);
    if (info->channel_count == 1) {
        info->sources[1] = info->sources[2] = info->sources[0];
        info->channel_count = 3;
    }
    return result;
}

/* ---- the header ---- */

exr_window window(const Imath::Box2i &box)
{
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

uint32_t rows_of(Imf::Compression compression)
{
    switch (compression) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
        return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
        return 32;
    case Imf::DWAB_COMPRESSION:
        return 256;
    default:
        return 1;
    }
}

/* Reads the first header; returns the version and the flags of the file. */
int read_header(const unsigned char *bytes, size_t size, Imf::Header &header)
{
    memory_input stream(bytes, size);
    int version = bytes[4] | bytes[5] << 8 | bytes[6] << 16;
    stream.seekg(8);
    header.readFrom(stream, version);
    return version;
}

/* The type of a channel in memory. */
Imf::PixelType type_of(const exr_channel &channel)
{
    return channel.is_integer ? Imf::UINT : Imf::FLOAT;
}

/* Whether the file has these channels, of their types at every texel. */
facet_result find_named(const Imf::ChannelList &list, const exr_channel *named, uint32_t count, char *message)
{
    for (uint32_t c = 0; c < count; c++) {
        const Imf::Channel *channel = list.findChannel(named[c].name);
        const char *fault = !channel ? "is missing"
                            : channel->type != type_of(named[c])
                                ? named[c].is_integer ? "does not hold integers" : "does not hold floats"
                            : channel->xSampling != 1 || channel->ySampling != 1
                                ? "is not sampled at every texel"
                                : nullptr;
        if (fault) {
            std::snprintf(message, EXR_MESSAGE, "channel %s %s", named[c].name, fault);
            return FACET_ERROR_INVALID;
        }
    }
    return FACET_OK;
}

/* The attribute of a name and type; NULL: none. Avoids findTypedAttribute(), whose instantiation would be an
 * exported symbol of the library. */
template <class type> const type *find_attribute(const Imf::Header &header, const char *name)
{
    const auto place = header.find(name);
    return place == header.end() ? nullptr : dynamic_cast<const type *>(&place.attribute());
}

void fill_color(const Imf::Header &header, exr_info *out)
{
    out->has_chromaticities = header.find("chromaticities") != header.end();
    for (float &x : out->chromaticities)
        x = std::numeric_limits<float>::quiet_NaN();
    if (const auto *found = find_attribute<Imf::ChromaticitiesAttribute>(header, "chromaticities")) {
        const Imf::Chromaticities &c = found->value();
        const Imath::V2f *const colors[] = {&c.red, &c.green, &c.blue, &c.white};
        for (int i = 0; i < 4; i++) {
            out->chromaticities[2 * i] = colors[i]->x;
            out->chromaticities[2 * i + 1] = colors[i]->y;
        }
    }
    if (const auto *found = find_attribute<Imf::EnvmapAttribute>(header, "envmap"))
        out->envmap = found->value() == Imf::ENVMAP_CUBE      ? IMAGE_ENVMAP_CUBE
                      : found->value() == Imf::ENVMAP_LATLONG ? IMAGE_ENVMAP_LATLONG
                                                              : IMAGE_ENVMAP_NONE;
}

facet_result fill_info(const unsigned char *bytes, size_t size, const exr_channel *named,
                       uint32_t named_count, exr_info *out, char *message)
{
    Imf::Header header;
    *out = exr_info{};
    const int version = read_header(bytes, size, header);
    if (Imf::isNonImage(version) || (header.hasType() && Imf::isDeepData(header.type())))
        return report(message, FACET_ERROR_UNSUPPORTED, "deep images are not read");
    out->data = window(header.dataWindow());
    out->display = window(header.displayWindow());
    fill_color(header, out);
    out->is_tiled =
        Imf::isMultiPart(version) ? header.hasType() && Imf::isTiled(header.type()) : Imf::isTiled(version);
    const Imf::Compression compression = header.compression();
    if (compression < 0 || compression >= Imf::NUM_COMPRESSION_METHODS)
        return report(message, FACET_ERROR_UNSUPPORTED, "the compression is not known");
    out->is_dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    out->chunk_rows = rows_of(compression);
    if (out->is_tiled) {
        if (!header.hasTileDescription())
            return report(message, FACET_ERROR_INVALID, "the tiles attribute is missing");
        out->tile_width = header.tileDescription().xSize;
        out->tile_height = out->chunk_rows = header.tileDescription().ySize;
    }
    for (channel_iterator c = header.channels().begin(); c != header.channels().end(); ++c)
        out->texel_size += c.channel().type == Imf::HALF ? 2 : 4;
    if (!named)
        return choose_channels(header.channels(), out, message);
    out->channel_count = named_count;
    return find_named(header.channels(), named, named_count, message);
}

} // namespace

facet_result exr_shim_info(const unsigned char *bytes, size_t size, const exr_channel *named,
                           uint32_t named_count, exr_info *out, char message[EXR_MESSAGE])
{
    try {
        return fill_info(bytes, size, named, named_count, out, message);
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

facet_result exr_shim_layer(const unsigned char *bytes, size_t size, const char *layer, exr_info *info,
                            char message[EXR_MESSAGE])
{
    try {
        Imf::Header header;
        read_header(bytes, size, header);
        return choose_layer(header.channels(), layer, info, message);
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

facet_result exr_shim_text(const unsigned char *bytes, size_t size, const char *attribute, char *value,
                           size_t value_size, char message[EXR_MESSAGE])
{
    try {
        Imf::Header header;
        read_header(bytes, size, header);
        const auto *found = find_attribute<Imf::StringAttribute>(header, attribute);
        if (!found || found->value().size() >= value_size) {
            std::snprintf(message, EXR_MESSAGE, "the text %s is %s", attribute,
                          found ? "too long" : "missing");
            return FACET_ERROR_INVALID;
        }
        std::snprintf(value, value_size, "%s", found->value().c_str());
        return FACET_OK;
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

/* ---- reading ---- */

struct exr_reader {
    memory_input stream;
    Imf::MultiPartInputFile file;
    Imf::InputPart part;

    exr_reader(const unsigned char *bytes, size_t size)
        : stream(bytes, size), file(stream, 0, false /* an incomplete table is not reconstructed */),
          part(file, 0)
    {
    }
};

facet_result exr_shim_open(const unsigned char *bytes, size_t size, exr_reader **out,
                           char message[EXR_MESSAGE])
{
    *out = nullptr;
    try {
        *out = new exr_reader(bytes, size);
        return FACET_OK;
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

void exr_shim_close(exr_reader *reader)
{
    delete reader;
}

facet_result exr_shim_read(exr_reader *reader, const exr_info *info, uint32_t row, uint32_t row_end,
                           float *texels, char message[EXR_MESSAGE])
{
    try {
        /* The library adds the file's x and y to the base pointer, which may lie outside of the block. */
        const size_t texel_size = info->channel_count * sizeof(float);
        const size_t width = static_cast<size_t>(int64_t{info->data.max_x} - info->data.min_x + 1);
        const int64_t first = int64_t{info->data.min_y} + row;
        const intptr_t before =
            static_cast<intptr_t>(texel_size) * (first * static_cast<intptr_t>(width) + info->data.min_x);
        Imf::FrameBuffer buffer;
        const bool is_grey = std::strcmp(info->sources[0].name, info->sources[1].name) == 0;
        for (uint32_t k = 0; k < info->channel_count; k++) {
            if (is_grey && (k == 1 || k == 2))
                continue;
            char *base = reinterpret_cast<char *>(reinterpret_cast<intptr_t>(texels + k) - before);
            buffer.insert(info->sources[k].name,
                          Imf::Slice(Imf::FLOAT, base, texel_size, texel_size * width));
        }
        reader->part.setFrameBuffer(buffer);
        reader->part.readPixels(static_cast<int>(first), info->data.min_y + static_cast<int>(row_end - 1));
        const size_t count = width * (row_end - row);
        for (size_t t = 0; is_grey && t < count; t++)
            texels[t * info->channel_count + 1] = texels[t * info->channel_count + 2] =
                texels[t * info->channel_count];
        return FACET_OK;
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

facet_result exr_shim_read_named(exr_reader *reader, const exr_info *info, const exr_channel *channels,
                                 uint32_t channel_count, char message[EXR_MESSAGE])
{
    try {
        Imf::FrameBuffer buffer;
        for (uint32_t c = 0; c < channel_count; c++) {
            const intptr_t before = static_cast<intptr_t>(channels[c].texel_stride) * info->data.min_x +
                                    static_cast<intptr_t>(channels[c].row_stride) * info->data.min_y;
            char *base = reinterpret_cast<char *>(reinterpret_cast<intptr_t>(channels[c].first) - before);
            buffer.insert(channels[c].name, Imf::Slice(type_of(channels[c]), base, channels[c].texel_stride,
                                                       channels[c].row_stride));
        }
        reader->part.setFrameBuffer(buffer);
        reader->part.readPixels(info->data.min_y, info->data.max_y);
        return FACET_OK;
    } catch (...) {
        return report_exception(message, FACET_ERROR_INVALID);
    }
}

/* ---- writing ---- */

namespace
{

enum { STRIP_ROWS = 16 /* of a ZIP chunk */ };

struct block_deleter {
    void operator()(uint16_t *block) const
    {
        mem_free(block);
    }
};

/* Floats or integers as they stand in memory. */
Imf::Slice slice_of(const exr_channel &channel)
{
    return Imf::Slice(type_of(channel), reinterpret_cast<char *>(channel.first), channel.texel_stride,
                      channel.row_stride);
}

void write_halves(Imf::OutputFile &file, uint32_t width, uint32_t height, const exr_channel *channels,
                  uint32_t channel_count, const facet_allocator *allocator)
{
    const size_t row_size = width * sizeof(uint16_t);
    std::unique_ptr<uint16_t, block_deleter> strip(static_cast<uint16_t *>(
        mem_alloc(allocator, static_cast<size_t>(STRIP_ROWS) * channel_count, row_size)));
    if (!strip)
        throw std::bad_alloc();
    for (uint32_t y = 0; y < height; y += STRIP_ROWS) {
        const uint32_t y_end = height - y > STRIP_ROWS ? y + STRIP_ROWS : height;
        Imf::FrameBuffer buffer;
        uint16_t *to = strip.get();
        for (uint32_t c = 0; c < channel_count; c++) {
            if (channels[c].needs_float) {
                buffer.insert(channels[c].name, slice_of(channels[c]));
                continue;
            }
            const intptr_t base = reinterpret_cast<intptr_t>(to) - static_cast<intptr_t>(y * row_size);
            buffer.insert(channels[c].name,
                          Imf::Slice(Imf::HALF, reinterpret_cast<char *>(base), sizeof(uint16_t), row_size));
            for (uint32_t row = y; row < y_end; row++, to += width) {
                const char *from =
                    reinterpret_cast<const char *>(channels[c].first) + row * channels[c].row_stride;
                for (uint32_t x = 0; x < width; x++, from += channels[c].texel_stride) {
                    float sample;
                    std::memcpy(&sample, from, sizeof sample);
                    to[x] = half(sample).bits();
                }
            }
        }
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(y_end - y));
    }
}

void write_floats(Imf::OutputFile &file, uint32_t height, const exr_channel *channels, uint32_t channel_count)
{
    Imf::FrameBuffer buffer;
    for (uint32_t c = 0; c < channel_count; c++) /* the library only reads */
        buffer.insert(channels[c].name, slice_of(channels[c]));
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(height));
}

} // namespace

facet_result exr_shim_write(const exr_write_desc *desc, const exr_channel *channels, uint32_t channel_count,
                            const facet_allocator *allocator, unsigned char **bytes, size_t *size,
                            char message[EXR_MESSAGE])
{
    try {
        memory_output stream(allocator);
        Imf::Header header(static_cast<int>(desc->width), static_cast<int>(desc->height));
        header.compression() = desc->is_stored ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
        header.zipCompressionLevel() = static_cast<int>(desc->level);
        for (uint32_t c = 0; c < channel_count; c++)
            header.channels().insert(
                channels[c].name,
                Imf::Channel(desc->as_half && !channels[c].needs_float ? Imf::HALF : type_of(channels[c])));
        for (uint32_t t = 0; t < desc->text_count; t++)
            header.insert(desc->texts[t].name, Imf::StringAttribute(desc->texts[t].value));
        {
            Imf::OutputFile file(stream, header, 0);
            if (desc->as_half)
                write_halves(file, desc->width, desc->height, channels, channel_count, allocator);
            else
                write_floats(file, desc->height, channels, channel_count);
        } /* writes its table of chunks here */
        *bytes = stream.take(size);
        return FACET_OK;
    } catch (...) {
        return report_exception(message, FACET_ERROR_ARGUMENT);
    }
}
