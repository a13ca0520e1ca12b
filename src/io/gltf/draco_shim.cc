/* draco_shim.cc - see draco_shim.h. The library's own entry point allocates memory for any counts in a
 * bitstream, so its two decoders are used through subclasses that check the counts first. */
#include "io/gltf/draco_shim.h"

#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

extern "C" {
#include "base/memory.h"
}

namespace
{

/* ---- limits ---- */

/* A generous estimate of the library's memory: corner tables and traversal marks; each component in its
 * encoded and stored form and as a prediction. */
enum { BYTES_PER_FACE = 160, BYTES_PER_COMPONENT = 16 };

/* In libdraco 1.5.5 an attribute of texture coordinates can declare 2^31 bits of orientations, which are
 * allocated (20 s, 512 MB) before their absence is noticed; callers cannot see the count. So few are
 * allowed. */
enum { MAX_ATTRIBUTES = 32 };

/* Compares counts with limits and reserves the memory in the budget. */
class guard
{
  public:
    guard(const draco_limits &limits, const facet_allocator *allocator)
        : limits_(limits), allocator_(allocator ? *allocator : facet_allocator{})
    {
        message_[0] = 0;
    }
    guard(const guard &) = delete;
    guard &operator=(const guard &) = delete;
    ~guard()
    {
        mem_account(&allocator_, -static_cast<ptrdiff_t>(taken_));
    }

    /* A mesh whose counts are known and whose faces are not read yet; seam_count: attributes with their
     * own seams, and so their own corner tables. */
    bool allow_faces(uint32_t face_count, uint32_t seam_count)
    {
        values_ = uint64_t{3} * face_count * (1 + seam_count);
        if (face_count > limits_.face_count)
            return refuse(FACET_ERROR_INVALID, "has %u triangles where %u are expected", face_count,
                          limits_.face_count);
        return allow_values() && take(uint64_t{BYTES_PER_FACE} * face_count * (1 + seam_count));
    }
    bool allow_points(uint32_t point_count)
    {
        return point_count <= limits_.point_count ||
               refuse(FACET_ERROR_INVALID, "has %u vertices where %u are expected", point_count,
                      limits_.point_count);
    }

    /* The attributes of a point cloud whose points and attributes are known and whose values are not read
     * yet. */
    bool allow_attributes(const draco::PointCloud &cloud)
    {
        uint64_t components = 0;
        if (cloud.num_attributes() > MAX_ATTRIBUTES)
            return refuse(FACET_ERROR_LIMIT, "has %d attributes, more than %d", cloud.num_attributes(),
                          static_cast<int>(MAX_ATTRIBUTES));
        for (int i = 0; i < cloud.num_attributes(); i++)
            components += cloud.attribute(i)->num_components();
        values_ += components * cloud.num_points();
        return allow_points(cloud.num_points()) && allow_values() &&
               take(BYTES_PER_COMPONENT * components * cloud.num_points());
    }

    /* FACET_OK: nothing was refused */
    facet_result result() const
    {
        return result_;
    }
    const char *message() const
    {
        return message_;
    }

  private:
    template <typename... T> bool refuse(facet_result result, const char *format, T... values)
    {
        result_ = result;
        std::snprintf(message_, sizeof message_, format, values...);
        return false;
    }
    bool allow_values()
    {
        return values_ <= limits_.value_count ||
               refuse(FACET_ERROR_LIMIT, "declares %llu values, far more than its bytes can hold",
                      static_cast<unsigned long long>(values_));
    }
    bool take(uint64_t bytes)
    {
        if (!mem_account(&allocator_, static_cast<ptrdiff_t>(bytes)))
            return refuse(FACET_ERROR_MEMORY, "needs %llu bytes to be decoded, more than are available",
                          static_cast<unsigned long long>(bytes));
        taken_ += bytes;
        return true;
    }

    draco_limits limits_;
    facet_allocator allocator_;
    uint64_t values_ = 0, taken_ = 0;
    facet_result result_ = FACET_OK;
    char message_[DRACO_MESSAGE];
};

/* ---- decoders ---- */

/* A count whose encoding differs between versions of the bitstream. */
bool read_count(draco::DecoderBuffer *in, uint16_t first_with_varint, uint32_t *out)
{
    return in->bitstream_version() < first_with_varint ? in->Decode(out) : draco::DecodeVarint(out, in);
}

class edgebreaker final : public draco::MeshEdgebreakerDecoder
{
  public:
    explicit edgebreaker(guard *g) : guard_(g)
    {
    }

  protected:
    bool DecodeConnectivity() override
    {
        draco::DecoderBuffer in = *buffer(); /* looks ahead */
        uint32_t added = 0, vertex_count = 0, face_count = 0;
        uint8_t seam_count = 0;
        const uint16_t v2_0 = DRACO_BITSTREAM_VERSION(2, 0), v2_2 = DRACO_BITSTREAM_VERSION(2, 2);
        if (in.bitstream_version() < v2_2 && !read_count(&in, v2_0, &added))
            return false;
        if (!read_count(&in, v2_0, &vertex_count) || !read_count(&in, v2_0, &face_count) ||
            !in.Decode(&seam_count))
            return false;
        return guard_->allow_faces(face_count, seam_count) &&
               draco::MeshEdgebreakerDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override
    {
        return guard_->allow_attributes(*point_cloud()) &&
               draco::MeshEdgebreakerDecoder::DecodeAllAttributes();
    }

  private:
    guard *guard_;
};

class sequential final : public draco::MeshSequentialDecoder
{
  public:
    explicit sequential(guard *g) : guard_(g)
    {
    }

  protected:
    bool DecodeConnectivity() override
    {
        draco::DecoderBuffer in = *buffer(); /* looks ahead */
        uint32_t face_count = 0, point_count = 0;
        const uint16_t v2_2 = DRACO_BITSTREAM_VERSION(2, 2);
        if (!read_count(&in, v2_2, &face_count) || !read_count(&in, v2_2, &point_count))
            return false;
        return guard_->allow_points(point_count) && guard_->allow_faces(face_count, 0) &&
               draco::MeshSequentialDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override
    {
        return guard_->allow_attributes(*point_cloud()) &&
               draco::MeshSequentialDecoder::DecodeAllAttributes();
    }

  private:
    guard *guard_;
};

facet_result say(char *message, facet_result result, const char *text)
{
    std::snprintf(message, DRACO_MESSAGE, "%s", text);
    return result;
}

} // namespace

struct draco_mesh {
    draco_mesh(const draco_limits &limits, const facet_allocator *allocator) : guarded(limits, allocator)
    {
    }
    guard guarded; /* returns the accounted bytes last */
    draco::Mesh mesh;
};

namespace
{

/* Whether all faces refer to existing points, which the library does not check for all bitstreams. */
bool are_faces_valid(const draco::Mesh &mesh)
{
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex &point : mesh.face(f))
            if (point.value() >= mesh.num_points())
                return false;
    return true;
}

/* Whether the values that points refer to exist. */
bool is_attribute_valid(const draco::PointAttribute &a, uint32_t point_count)
{
    const int64_t size = static_cast<int64_t>(a.size());
    if (!a.buffer() || a.byte_stride() <= 0 || a.byte_offset() < 0 ||
        a.byte_offset() + size * a.byte_stride() > static_cast<int64_t>(a.buffer()->data_size()))
        return false;
    if (a.is_mapping_identity())
        return a.size() >= point_count;
    if (a.indices_map_size() < point_count)
        return false;
    for (draco::PointIndex p(0); p < point_count; ++p)
        if (a.mapped_index(p).value() >= a.size())
            return false;
    return true;
}

facet_result decode(const unsigned char *bytes, size_t size, draco_mesh *out, char *message)
{
    draco::DecoderBuffer in;
    draco::DracoHeader header;
    in.Init(reinterpret_cast<const char *>(bytes), size);
    draco::DecoderBuffer ahead = in;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok())
        return say(message, FACET_ERROR_INVALID, "does not begin with Draco's signature");
    if (header.encoder_type != draco::TRIANGULAR_MESH)
        return say(message, FACET_ERROR_INVALID, "holds points where a mesh is expected");
    std::unique_ptr<draco::MeshDecoder> decoder;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
        decoder = std::make_unique<edgebreaker>(&out->guarded);
    else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
        decoder = std::make_unique<sequential>(&out->guarded);
    else
        return say(message, FACET_ERROR_UNSUPPORTED, "has an unknown encoding");
    const draco::DecoderOptions options;
    const draco::Status status = decoder->Decode(options, &in, &out->mesh);
    if (out->guarded.result() != FACET_OK)
        return say(message, out->guarded.result(), out->guarded.message());
    if (!status.ok()) {
        const char *why = status.error_msg();
        std::snprintf(message, DRACO_MESSAGE, "is damaged%s%s", *why ? ": " : "", why);
        return status.code() == draco::Status::UNKNOWN_VERSION ? FACET_ERROR_UNSUPPORTED
                                                               : FACET_ERROR_INVALID;
    }
    bool is_valid = are_faces_valid(out->mesh);
    for (int i = 0; i < out->mesh.num_attributes(); i++)
        is_valid = is_valid && is_attribute_valid(*out->mesh.attribute(i), out->mesh.num_points());
    return is_valid ? FACET_OK : say(message, FACET_ERROR_INVALID, "refers to vertices that do not exist");
}

} // namespace

facet_result draco_shim_decode(const unsigned char *bytes, size_t size, const draco_limits *limits,
                               const facet_allocator *allocator, draco_mesh **out,
                               char message[DRACO_MESSAGE])
{
    *out = nullptr;
    message[0] = 0;
    try {
        std::unique_ptr<draco_mesh> mesh = std::make_unique<draco_mesh>(*limits, allocator);
        const facet_result result = decode(bytes, size, mesh.get(), message);
        if (result == FACET_OK)
            *out = mesh.release();
        return result;
    } catch (const std::bad_alloc &) {
        return say(message, FACET_ERROR_MEMORY, "needs more memory than is available");
    } catch (...) {
        return say(message, FACET_ERROR_INVALID, "is damaged");
    }
}

void draco_shim_destroy(draco_mesh *mesh)
{
    delete mesh;
}

/* ---- access to a mesh ---- */

uint32_t draco_shim_face_count(const draco_mesh *mesh)
{
    return mesh->mesh.num_faces();
}

uint32_t draco_shim_point_count(const draco_mesh *mesh)
{
    return mesh->mesh.num_points();
}

uint32_t draco_shim_component_count(const draco_mesh *mesh, uint32_t unique_id)
{
    const draco::PointAttribute *a = mesh->mesh.GetAttributeByUniqueId(unique_id);
    return a ? a->num_components() : 0;
}

void draco_shim_copy_faces(const draco_mesh *mesh, uint32_t *out)
{
    for (draco::FaceIndex f(0); f < mesh->mesh.num_faces(); ++f)
        for (const draco::PointIndex &point : mesh->mesh.face(f))
            *out++ = point.value();
}

namespace
{

/* Values that have the wanted type already. */
void copy_values(const draco::PointAttribute &a, uint32_t point_count, size_t size, unsigned char *out)
{
    if (a.is_mapping_identity() && static_cast<size_t>(a.byte_stride()) == size) {
        std::memcpy(out, a.GetAddress(draco::AttributeValueIndex(0)), point_count * size);
        return;
    }
    for (draco::PointIndex p(0); p < point_count; ++p, out += size)
        std::memcpy(out, a.GetAddressOfMappedIndex(p), size);
}

template <typename T>
bool convert_values(const draco::PointAttribute &a, uint32_t point_count, draco::DataType type, void *out)
{
    T *at = static_cast<T *>(out);
    const size_t component_count = a.num_components();
    if (a.data_type() == type) {
        copy_values(a, point_count, component_count * sizeof(T), static_cast<unsigned char *>(out));
        return true;
    }
    const bool is_float = a.data_type() == draco::DT_FLOAT32 || a.data_type() == draco::DT_FLOAT64;
    if (is_float && type != draco::DT_FLOAT32)
        return false;
    for (draco::PointIndex p(0); p < point_count; ++p, at += component_count)
        if (!a.ConvertValue<T>(a.mapped_index(p), at))
            return false;
    return true;
}

} // namespace

bool draco_shim_copy_attribute(const draco_mesh *mesh, uint32_t unique_id, draco_type type, void *out)
{
    const draco::PointAttribute *a = mesh->mesh.GetAttributeByUniqueId(unique_id);
    const uint32_t count = mesh->mesh.num_points();
    if (!a || count == 0)
        return a != nullptr;
    switch (type) {
    case DRACO_I8:
        return convert_values<int8_t>(*a, count, draco::DT_INT8, out);
    case DRACO_U8:
        return convert_values<uint8_t>(*a, count, draco::DT_UINT8, out);
    case DRACO_I16:
        return convert_values<int16_t>(*a, count, draco::DT_INT16, out);
    case DRACO_U16:
        return convert_values<uint16_t>(*a, count, draco::DT_UINT16, out);
    case DRACO_U32:
        return convert_values<uint32_t>(*a, count, draco::DT_UINT32, out);
    case DRACO_F32:
        return convert_values<float>(*a, count, draco::DT_FLOAT32, out);
    }
    return false;
}
