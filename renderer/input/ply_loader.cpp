#include "renderer/input/ply_loader.h"
#include "renderer/base/math.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "renderer/files/file_io.h"
#include "renderer/input/inflate.h"
#include "renderer/input/ply/ply_header.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Embree counts in 32 bits.
constexpr int64_t kMostElements = std::numeric_limits<int32_t>::max();

// Names where the values of a vertex property go.
enum Slot { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kSlots };

using SlotMap = std::array<int, kSlots>;

// Names of texture coordinates of vertices, in lower case without underscores; pbrt-v3 reads u and
// v, s and t, texture_u and texture_v, texture_s and texture_t.
constexpr std::pair<const char*, const char*> kUvs[] = {{"u", "v"},
                                                        {"s", "t"},
                                                        {"textureu", "texturev"},
                                                        {"textures", "texturet"},
                                                        {"texcoordu", "texcoordv"},
                                                        {"texcoords", "texcoordt"},
                                                        {"texcoordx", "texcoordy"},
                                                        {"texu", "texv"},
                                                        {"texs", "text"},
                                                        {"tu", "tv"},
                                                        {"uvu", "uvv"},
                                                        {"u0", "v0"},
                                                        {"s0", "t0"},
                                                        {"u1", "v1"},
                                                        {"s1", "t1"}};

std::string WithoutCase(std::string name) {
    std::erase(name, '_');
    return LowerCase(name);
}

SlotMap MapSlots(const PlyElement& vertex, const FileLoc& loc) {
    SlotMap slots;
    slots.fill(-1);
    const auto assign = [&](int first, std::initializer_list<const char*> names) {
        std::vector<int> found;
        for (const char* name : names) {
            const auto it =
                std::ranges::find_if(vertex.properties, [&](const PlyProperty& property) {
                    const bool isSame = property.name == name ||
                                        (first == kU && WithoutCase(property.name) == name);
                    return isSame && !property.isList;
                });
            if (it == vertex.properties.end()) return false;
            found.push_back(int(it - vertex.properties.begin()));
        }
        std::ranges::copy(found, slots.begin() + first);
        return true;
    };
    if (!assign(kX, {"x", "y", "z"}))
        throw Error(loc, "the vertices of the PLY file have no x, y and z");
    assign(kNx, {"nx", "ny", "nz"});
    for (const auto& [u, v] : kUvs)
        if (assign(kU, {u, v})) break;
    return slots;
}

struct Column {
    float* values;
    size_t stride;
};

Column ColumnOf(MeshData* mesh, int slot) {
    if (slot < kNx) return {mesh->positions.data()->data() + slot, 3};
    if (slot < kU) return {mesh->normals.data()->data() + (slot - kNx), 3};
    return {mesh->uvs.data()->data() + (slot - kU), 2};
}

size_t LeastRowBytes(const PlyElement& element, PlyFormat format) {
    size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += format == PlyFormat::Ascii
                     ? 1
                     : PlyTypeSize(property.isList ? property.countType : property.type);
    return bytes;
}

bool HasFixedRows(const PlyElement& element, PlyFormat format) {
    return format != PlyFormat::Ascii &&
           std::ranges::none_of(element.properties, &PlyProperty::isList);
}

void ReadVertices(const PlyElement& element, PlyCursor& cursor, MeshData* mesh) {
    const SlotMap slots = MapSlots(element, {cursor.loc.file});
    const size_t count = size_t(element.count);
    mesh->positions.resize(count);
    if (slots[kNx] >= 0) mesh->normals.resize(count);
    if (slots[kU] >= 0) mesh->uvs.resize(count);
    // A property fills at most one slot, for no name belongs to two.
    std::vector<int> slotOf(element.properties.size(), -1);
    for (int slot = 0; slot < kSlots; ++slot)
        if (slots[slot] >= 0) slotOf[slots[slot]] = slot;
    for (size_t i = 0; i < count; ++i)
        for (size_t p = 0; p < element.properties.size(); ++p) {
            if (slotOf[p] < 0) {
                cursor.SkipProperty(element.properties[p]);
                continue;
            }
            const Column column = ColumnOf(mesh, slotOf[p]);
            column.values[i * column.stride] = float(cursor.Read(element.properties[p].type));
        }
}

// Reads the rows up to the next that is no triangle, if they hold nothing but a list with 1-byte
// counts and 4-byte indices in this machine's order. Returns how many.
int64_t ReadTrianglesInBulk(const PlyElement& element, int64_t most, PlyCursor& cursor,
                            MeshData* mesh) {
    const PlyProperty& list = element.properties[0];
    if (element.properties.size() != 1 || cursor.format != PlyFormat::LittleEndian ||
        PlyTypeSize(list.countType) != 1 ||
        (list.type != PlyType::Int32 && list.type != PlyType::Uint32))
        return 0;
    constexpr size_t kRow = 1 + 3 * sizeof(uint32_t);
    int64_t rows = 0;
    for (; rows < most && cursor.Remaining() >= kRow && *cursor.pos == 3; ++rows)
        std::memcpy(mesh->triangles.emplace_back().data(), cursor.Skip(kRow) + 1, kRow - 1);
    return rows;
}

uint32_t IndexOf(double written, const PlyCursor& cursor) {
    const double index = std::round(written);
    if (!(index >= 0 && index <= double(kMostElements)) ||
        !(std::abs(written - index) <= kRounding))
        throw Error(cursor.loc, "a face has the vertex index " + std::to_string(written));
    return uint32_t(index);
}

struct Face {
    size_t corners = 0;
    std::vector<uint32_t> vertices;  // empty: more than are modelled
    std::vector<float> uvs;          // of the corners; empty: it has none
    int index = 0;
};

// Names of the lists of texture coordinates, two a corner, as MeshLab and others write them.
constexpr std::string_view kWedgeUvs[] = {"texcoord", "texcoords", "texture_uv", "texture_coords",
                                          "uv",       "uvs",       "st",         "t"};

bool IsIndices(const PlyProperty& property) {
    return property.isList &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}
bool IsWedgeUvs(const PlyProperty& property) {
    return property.isList && std::ranges::count(kWedgeUvs, property.name) > 0;
}
bool IsFaceIndex(const PlyProperty& property) {
    return property.name == "face_indices" && !property.isList;
}

void ReadIndices(const PlyProperty& list, PlyCursor& cursor, Face* face) {
    face->corners = cursor.ReadListCount(list);
    const bool isModelled = face->corners <= kMostPolygonCorners;
    for (size_t i = 0; i < face->corners; ++i)
        if (isModelled)
            face->vertices.push_back(IndexOf(cursor.Read(list.type), cursor));
        else
            cursor.Read(list.type);
}

void ReadWedgeUvs(const PlyProperty& list, PlyCursor& cursor, Face* face) {
    face->uvs.resize(cursor.ReadListCount(list));
    for (float& value : face->uvs) value = float(cursor.Read(list.type));
}

void ReadFace(const PlyElement& element, PlyCursor& cursor, Face* face) {
    face->vertices.clear();
    face->uvs.clear();
    for (const PlyProperty& property : element.properties) {
        if (IsIndices(property)) {
            ReadIndices(property, cursor, face);
        } else if (IsWedgeUvs(property)) {
            ReadWedgeUvs(property, cursor, face);
        } else if (IsFaceIndex(property)) {
            const double value = cursor.Read(property.type);
            if (!(std::abs(value) <= double(kMostElements)))
                throw Error(cursor.loc, "a face index is beyond the range of an integer");
            face->index = int(value);
        } else {
            cursor.SkipProperty(property);
        }
    }
}

// Texture coordinates of the corners of triangles; none where they are those of the vertices.
using WedgeUvs = std::vector<std::optional<std::array<Vec2f, 3>>>;

void AddFace(const Face& face, const FileLoc& loc, MeshData* mesh, WedgeUvs* uvs,
             Warnings& warnings) {
    if (face.corners < 3 || face.vertices.empty()) {
        warnings.Add(
            loc, fmt::format("face left out that has not 3 to {} vertices", kMostPolygonCorners),
            fmt::format("it has {}", face.corners));
        return;
    }
    const bool hasUvs = face.uvs.size() == 2 * face.corners;
    if (uvs && !hasUvs && !face.uvs.empty())
        warnings.Add(loc, "texture coordinates of a face left out: it needs two for each vertex",
                     "it has " + std::to_string(face.uvs.size()) + " for " +
                         std::to_string(face.corners) + " vertices");
    for (const auto& [a, b, c] : TrianglesOf(face.vertices, mesh->positions)) {
        mesh->triangles.push_back({face.vertices[a], face.vertices[b], face.vertices[c]});
        if (!uvs) continue;
        const auto at = [&](size_t i) { return Vec2f(face.uvs[2 * i], face.uvs[2 * i + 1]); };
        uvs->emplace_back();
        if (hasUvs) uvs->back() = {at(a), at(b), at(c)};
    }
}

// Adds the triangles of strips, every other one of which is turned. -1, in unsigned lists the
// largest number, begins another strip, and triangles without area join some.
void ReadStrips(const PlyElement& element, PlyCursor& cursor, MeshData* mesh) {
    const auto readStrip = [&](const PlyProperty& list) {
        std::vector<uint32_t> strip;
        for (size_t left = cursor.ReadListCount(list); left > 0; --left) {
            const double written = cursor.Read(list.type);
            const bool isLargest = written == std::exp2(8 * PlyTypeSize(list.type)) - 1 &&
                                   !(written < double(mesh->positions.size()));
            if (written == -1 || isLargest) {
                strip.clear();
                continue;
            }
            strip.push_back(IndexOf(written, cursor));
            if (strip.size() < 3) continue;
            const auto [a, b, c] = std::to_array(
                {strip[strip.size() - 3], strip[strip.size() - 2], strip[strip.size() - 1]});
            if (a == b || b == c || c == a) continue;
            mesh->triangles.push_back(strip.size() % 2 ? std::array{a, b, c} : std::array{b, a, c});
        }
    };
    for (int64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties)
            if (IsIndices(property))
                readStrip(property);
            else
                cursor.SkipProperty(property);
}

WedgeUvs ReadFaces(const PlyElement& element, PlyCursor& cursor, MeshData* mesh,
                   Warnings& warnings) {
    if (std::ranges::count_if(element.properties, IsIndices) != 1)
        throw Error({cursor.loc.file}, "the faces of the PLY file need one list vertex_indices");
    // Kept to the triangles below, since a face may become two of them or none.
    const bool hasFaceIndices = std::ranges::any_of(element.properties, IsFaceIndex);
    const bool hasUvs = std::ranges::any_of(element.properties, IsWedgeUvs);
    WedgeUvs uvs(hasUvs ? mesh->triangles.size() : 0);  // those of strips have none
    Face face;
    mesh->triangles.reserve(mesh->triangles.size() + size_t(element.count));
    for (int64_t i = 0; i < element.count; ++i) {
        i += ReadTrianglesInBulk(element, element.count - i, cursor, mesh);
        if (i == element.count) break;
        ReadFace(element, cursor, &face);
        AddFace(face, cursor.loc, mesh, hasUvs ? &uvs : nullptr, warnings);
        if (hasFaceIndices) mesh->faceIndices.resize(mesh->triangles.size(), face.index);
    }
    return uvs;
}

// Gives the corners of triangles uvs of their own: a vertex becomes as many as it has uvs.
void SplitVertices(const WedgeUvs& uvs, MeshData* mesh) {
    if (std::ranges::none_of(uvs, [](const auto& uv) { return uv.has_value(); })) return;
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    const std::vector<Vec3f> positions = std::exchange(mesh->positions, {});
    const std::vector<Vec3f> normals = std::exchange(mesh->normals, {});
    const std::vector<Vec2f> own = std::exchange(mesh->uvs, {});
    // The copies of a vertex are a list that begins with the latest.
    std::vector<uint32_t> latest(positions.size(), kNone), next;
    for (size_t i = 0; i < uvs.size(); ++i)
        for (size_t k = 0; k < 3; ++k) {
            uint32_t& vertex = mesh->triangles[i][k];
            const Vec2f uv = uvs[i] ? (*uvs[i])[k] : own.empty() ? Vec2f(0, 0) : own[vertex];
            uint32_t copy = latest[vertex];
            while (copy != kNone && mesh->uvs[copy] != uv) copy = next[copy];
            if (copy == kNone) {
                copy = uint32_t(mesh->positions.size());
                mesh->positions.push_back(positions[vertex]);
                if (!normals.empty()) mesh->normals.push_back(normals[vertex]);
                mesh->uvs.push_back(uv);
                next.push_back(std::exchange(latest[vertex], copy));
            }
            vertex = copy;
        }
}

void SkipElement(const PlyElement& element, PlyCursor& cursor) {
    if (element.properties.empty()) return;
    if (HasFixedRows(element, cursor.format)) {
        cursor.Skip(size_t(element.count) * LeastRowBytes(element, cursor.format));
        return;
    }
    for (int64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties) cursor.SkipProperty(property);
}

// pbrt-v3 leaves these out as well.
void WarnOfOmissions(const PlyElement& element, const FileLoc& loc, Warnings& warnings) {
    const auto has = [&](const char* name) {
        return std::ranges::find(element.properties, name, &PlyProperty::name) !=
               element.properties.end();
    };
    if (element.count == 0) return;
    const bool isVertex = element.name == "vertex";
    const bool isOfMesh = isVertex || element.name == "face";
    if (isOfMesh && (has("red") || has("diffuse_red") || has("r")))
        warnings.Add(loc, "colours of a PLY file are left out; glTF files can have them");
    std::unordered_set<std::string_view> names;
    for (const PlyProperty& property : element.properties)
        if (isOfMesh && !names.insert(property.name).second)
            warnings.Add(loc, "PLY property given twice, of which one counts",
                         Printable(property.name));
    const auto isUv = [](const PlyProperty& property) {
        return std::ranges::count(kUvs, WithoutCase(property.name),
                                  &std::pair<const char*, const char*>::first) > 0;
    };
    const bool hasUvs = std::ranges::any_of(element.properties, isUv);
    for (const PlyProperty& property : element.properties)
        if (isVertex && !hasUvs &&
            (IsWedgeUvs(property) || WithoutCase(property.name).starts_with("tex")))
            warnings.Add(loc,
                         "texture coordinates of a PLY file are left out; call them u and v, one "
                         "property each",
                         Printable(property.name));
}

template <typename T>
void ReplaceNonFinite(std::vector<T>* values, const char* kind, const FileLoc& loc,
                      Warnings& warnings) {
    for (T& value : *values)
        if (!value.allFinite()) {
            value.setZero();
            warnings.Add(loc, kind);
        }
}

void CheckMesh(MeshData* mesh, const FileLoc& loc, Warnings& warnings) {
    for (size_t i = 0; i < mesh->triangles.size(); ++i)
        for (const uint32_t index : mesh->triangles[i]) {
            if (index >= mesh->positions.size())
                throw Error(loc, "triangle {} refers to vertex {}, but there are {}", i, index,
                            mesh->positions.size());
            if (!mesh->positions[index].allFinite())
                throw Error(loc, "vertex {} of the PLY file is not finite", index);
        }
    // The others are of no triangle; they must not widen the mesh.
    for (Vec3f& position : mesh->positions)
        if (!position.allFinite()) {
            position = mesh->positions[mesh->triangles[0][0]];
            warnings.Add(loc, "unused vertex of a PLY file that is not finite");
        }
    ReplaceNonFinite(&mesh->normals, "normal in a PLY file that is not finite", loc, warnings);
}

}  // namespace

MeshData LoadPly(const std::string& path, Warnings& warnings, const FileLoc& loc) {
    const FileLoc place{std::make_shared<const std::string>(path), 0};
    const FileContents contents = Inflated(ReadFile(path, loc), place);
    const std::string_view file = WithoutByteOrderMark(contents.View(), place);
    const PlyHeader header = ParsePlyHeader(file, place);
    const bool isText = header.format == PlyFormat::Ascii;
    const std::string_view rows = file.substr(header.bytes),
                           data = isText ? WithoutEndMarks(rows) : rows;
    PlyCursor cursor{data.data(), data.data() + data.size(), header.format, place};
    if (isText) cursor.loc.line = header.lines + 1;

    MeshData mesh;
    WedgeUvs wedgeUvs;
    bool hasVertices = false, hasFaces = false;
    for (const PlyElement& element : header.elements) {
        // Nothing is allocated for rows that cannot be there.
        const size_t rowBytes = LeastRowBytes(element, header.format);
        const bool isVertex = element.name == "vertex", isFace = element.name == "face";
        if (rowBytes > 0 && size_t(element.count) > cursor.Remaining() / rowBytes)
            throw Error(place, "the PLY file ends before the " + std::to_string(element.count) +
                                   " rows of element '" + Printable(element.name) + "'");
        if ((isVertex && std::exchange(hasVertices, true)) ||
            (isFace && std::exchange(hasFaces, true)))
            throw Error(place, "the PLY file has two elements '" + element.name + "'");
        if ((isVertex || isFace) && element.count > kMostElements)
            throw Error(place, "the PLY file has more than 2^31 - 1 rows in element '" +
                                   element.name + "'");
        if (isVertex)
            ReadVertices(element, cursor, &mesh);
        else if (isFace)
            wedgeUvs = ReadFaces(element, cursor, &mesh, warnings);
        else if (element.name == "tristrips")
            ReadStrips(element, cursor, &mesh);
        else
            SkipElement(element, cursor);
        WarnOfOmissions(element, place, warnings);
    }
    if (mesh.triangles.empty()) {
        const bool isMesh = std::ranges::any_of(header.elements, [](const PlyElement& element) {
            return element.name == "face" || element.name == "tristrips";
        });
        if (!isMesh) throw Error(place, "the PLY file has no faces");
        warnings.Add(place, "a PLY file without triangles is left out");
        return {};
    }
    CheckMesh(&mesh, place, warnings);
    // Strips may follow the faces, and have no such values.
    if (!mesh.faceIndices.empty()) mesh.faceIndices.resize(mesh.triangles.size());
    if (!wedgeUvs.empty()) wedgeUvs.resize(mesh.triangles.size());
    SplitVertices(wedgeUvs, &mesh);
    ReplaceNonFinite(&mesh.uvs, "uv in a PLY file that is not finite", place, warnings);
    return mesh;
}

}  // namespace lull
