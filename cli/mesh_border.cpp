// mesh_border.cpp: the border to tinygltf and lib3mf.
#include "cli/mesh_border.h"

#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <Model/COM/NMR_DLLInterfaces.h>

namespace
{

// ---- glTF ----

double linear_of(unsigned char byte)
{
    double encoded = byte / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

template <typename Number> void append(std::vector<unsigned char> &bytes, Number number)
{
    const unsigned char *begin = reinterpret_cast<const unsigned char *>(&number);
    bytes.insert(bytes.end(), begin, begin + sizeof number);
}

// What is appended to the only buffer from here on is an accessor.
tinygltf::Accessor &add_accessor(tinygltf::Model &model, int target, int component, int type,
                                 size_t count)
{
    tinygltf::BufferView view;
    tinygltf::Accessor   accessor;
    view.buffer            = 0;
    view.byteOffset        = model.buffers[0].data.size();
    view.target            = target;
    accessor.bufferView    = (int)model.bufferViews.size();
    accessor.componentType = component;
    accessor.type          = type;
    accessor.count         = count;
    model.bufferViews.push_back(view);
    model.accessors.push_back(accessor);
    return model.accessors.back();
}

int end_accessor(tinygltf::Model &model)
{
    tinygltf::BufferView &view = model.bufferViews.back();
    view.byteLength            = model.buffers[0].data.size() - view.byteOffset;
    while (model.buffers[0].data.size() % 4 != 0)
        model.buffers[0].data.push_back(0);
    return (int)model.accessors.size() - 1;
}

int add_positions(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part)
{
    double              scale    = parts->scale * parts->metres;
    tinygltf::Accessor &accessor = add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER,
                                                TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                                part.vertex_count);
    accessor.minValues.assign(3, HUGE_VAL);
    accessor.maxValues.assign(3, -HUGE_VAL);
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            float number          = (float)(scale * parts->vertices[i][k]);
            accessor.minValues[k] = std::fmin(accessor.minValues[k], number);
            accessor.maxValues[k] = std::fmax(accessor.maxValues[k], number);
            append(model.buffers[0].data, number);
        }
    return end_accessor(model);
}

// Linear, sixteen bits; the fourth number is for alignment.
int add_colors(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part)
{
    add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                 TINYGLTF_TYPE_VEC4, part.vertex_count)
        .normalized = true;
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++) {
        for (int k = 0; k < 3; k++)
            append(model.buffers[0].data,
                   (uint16_t)std::lrint(65535 * linear_of(parts->colors[i][k])));
        append(model.buffers[0].data, (uint16_t)65535);
    }
    return end_accessor(model);
}

int add_triangles(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part,
                  uint32_t material)
{
    size_t count = 0, end = part.first_triangle + part.triangle_count;
    for (size_t i = part.first_triangle; i < end; i++)
        count += parts->material_of[i] == material;
    if (count == 0)
        return -1;
    add_accessor(model, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                 TINYGLTF_TYPE_SCALAR, 3 * count);
    for (size_t i = part.first_triangle; i < end; i++)
        for (int k = 0; k < 3 && parts->material_of[i] == material; k++)
            append(model.buffers[0].data, (uint32_t)(parts->triangles[i][k] - part.first_vertex));
    return end_accessor(model);
}

void add_part(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part)
{
    tinygltf::Mesh mesh;
    tinygltf::Node node;
    int            positions = add_positions(model, parts, part);
    int            colors    = add_colors(model, parts, part);
    for (uint32_t material = 0; material < parts->material_count; material++) {
        int triangles = add_triangles(model, parts, part, material);
        if (triangles < 0)
            continue;
        tinygltf::Primitive primitive;
        primitive.attributes["POSITION"] = positions;
        primitive.attributes["COLOR_0"]  = colors;
        primitive.indices                = triangles;
        primitive.material               = (int)material;
        primitive.mode                   = TINYGLTF_MODE_TRIANGLES;
        mesh.primitives.push_back(primitive);
    }
    mesh.name = node.name = part.name;
    node.mesh             = (int)model.meshes.size();
    model.scenes[0].nodes.push_back((int)model.nodes.size());
    model.meshes.push_back(mesh);
    model.nodes.push_back(node);
}

void add_materials(tinygltf::Model &model, const MeshParts *parts)
{
    for (size_t i = 0; i < parts->material_count; i++) {
        tinygltf::Material material;
        material.name                                 = parts->materials[i].name;
        material.pbrMetallicRoughness.roughnessFactor = parts->materials[i].roughness;
        material.pbrMetallicRoughness.metallicFactor  = parts->materials[i].metallic;
        model.materials.push_back(material);
    }
}

// A stream whose bytes go to the sink.
class SinkStream : public std::streambuf
{
  public:
    SinkStream(MeshSink *to, void *user) : sink(to), data(user) {}

  protected:
    std::streamsize xsputn(const char *bytes, std::streamsize count) override
    {
        return sink(data, bytes, (size_t)count) ? count : 0;
    }
    int overflow(int byte) override
    {
        char one = (char)byte;
        return byte != EOF && sink(data, &one, 1) ? byte : EOF;
    }

  private:
    MeshSink *sink;
    void     *data;
};

// ---- 3MF ----

struct Failure {
};

void check(LIB3MFRESULT result)
{
    if (result != 0)
        throw Failure();
}

// Released when it is no longer used.
template <typename Thing> class Owned
{
  public:
    Owned() : thing(nullptr) {}
    ~Owned()
    {
        if (thing)
            NMR::lib3mf_release(thing);
    }
    Thing **place() { return &thing; }
            operator Thing *() const { return thing; }

  private:
    Owned(const Owned &);
    Thing *thing;
};

typedef Owned<NMR::PLib3MFModel> Model;

NMR::eModelUnit unit_of(const std::string &unit)
{
    return unit == "um"   ? NMR::MODELUNIT_MICROMETER
           : unit == "cm" ? NMR::MODELUNIT_CENTIMETER
           : unit == "m"  ? NMR::MODELUNIT_METER
           : unit == "in" ? NMR::MODELUNIT_INCH
           : unit == "ft" ? NMR::MODELUNIT_FOOT
                          : NMR::MODELUNIT_MILLIMETER;
}

void put_in_geometry(const MeshParts *parts, const MeshPart &part,
                     NMR::PLib3MFModelMeshObject *object)
{
    std::vector<NMR::MODELMESHVERTEX>   vertices(part.vertex_count);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(part.triangle_count);
    for (size_t i = 0; i < part.vertex_count; i++)
        for (int k = 0; k < 3; k++)
            vertices[i].m_fPosition[k] = (float)(parts->scale *
                                                 parts->vertices[part.first_vertex + i][k]);
    for (size_t i = 0; i < part.triangle_count; i++)
        for (int k = 0; k < 3; k++)
            triangles[i].m_nIndices[k] = parts->triangles[part.first_triangle + i][k] -
                                         (uint32_t)part.first_vertex;
    check(NMR::lib3mf_meshobject_setgeometry(object, vertices.data(), (DWORD)vertices.size(),
                                             triangles.data(), (DWORD)triangles.size()));
}

void paint(const MeshParts *parts, const MeshPart &part, NMR::PLib3MFModelMeshObject *object,
           NMR::ModelResourceID group, const std::vector<DWORD> &numbers)
{
    Owned<NMR::PLib3MFPropertyHandler>        handler;
    Owned<NMR::PLib3MFDefaultPropertyHandler> usual; /* must be there as well */
    std::vector<NMR::ModelResourceID>         groups(part.triangle_count, group);
    std::vector<DWORD>                        materials(part.triangle_count);
    for (size_t i = 0; i < part.triangle_count; i++)
        materials[i] = numbers[parts->material_of[part.first_triangle + i]];
    check(NMR::lib3mf_meshobject_createpropertyhandler(object, handler.place()));
    check(
        NMR::lib3mf_propertyhandler_setbasematerialarray(handler, groups.data(), materials.data()));
    check(NMR::lib3mf_object_createdefaultpropertyhandler(object, usual.place()));
    check(NMR::lib3mf_defaultpropertyhandler_setbasematerial(usual, group, numbers[0]));
}

NMR::ModelResourceID add_base_materials(const MeshParts *parts, const Model &model,
                                        std::vector<DWORD> &numbers)
{
    Owned<NMR::PLib3MFModelBaseMaterial> group;
    NMR::ModelResourceID                 id;
    check(NMR::lib3mf_model_addbasematerialgroup(model, group.place()));
    for (size_t i = 0; i < parts->material_count; i++) {
        const MeshMaterial &material = parts->materials[i];
        check(NMR::lib3mf_basematerial_addmaterialutf8(group, material.name, material.color[0],
                                                       material.color[1], material.color[2],
                                                       &numbers[i]));
        check(NMR::lib3mf_basematerial_setdisplaycolorrgba(
            group, (DWORD)i, material.color[0], material.color[1], material.color[2], 255));
    }
    check(NMR::lib3mf_basematerial_getresourceid(group, &id));
    return id;
}

void add_objects(const MeshParts *parts, const Model &model)
{
    std::vector<DWORD>   numbers(parts->material_count);
    NMR::ModelResourceID group = add_base_materials(parts, model, numbers);
    check(NMR::lib3mf_model_setunit(model, unit_of(parts->unit)));
    for (size_t i = 0; i < parts->part_count; i++) {
        Owned<NMR::PLib3MFModelMeshObject> object;
        Owned<NMR::PLib3MFModelBuildItem>  item;
        check(NMR::lib3mf_model_addmeshobject(model, object.place()));
        check(NMR::lib3mf_object_setnameutf8(object, parts->parts[i].name));
        put_in_geometry(parts, parts->parts[i], object);
        paint(parts, parts->parts[i], object, group, numbers);
        check(NMR::lib3mf_model_addbuilditem(model, object, nullptr, item.place()));
    }
}

// The archive while it is written: places of it are filled in later.
struct Archive {
    std::vector<unsigned char> bytes;
    size_t                     at = 0;
};

int archive_write(const void *bytes, DWORD count, void *user)
{
    Archive *archive = (Archive *)user;
    if (archive->at + count > archive->bytes.size())
        archive->bytes.resize(archive->at + count);
    std::memcpy(archive->bytes.data() + archive->at, bytes, count);
    archive->at += count;
    return 0;
}

int archive_seek(ULONG64 place, void *user)
{
    ((Archive *)user)->at = place;
    return 0;
}

bool write_model(const Model &model, MeshSink *sink, void *user)
{
    Owned<NMR::PLib3MFModelWriter> writer;
    Archive                        archive;
    check(NMR::lib3mf_model_querywriter(model, "3mf", writer.place()));
    check(NMR::lib3mf_writer_writetocallback(writer, (void *)archive_write, (void *)archive_seek,
                                             &archive));
    return sink(user, archive.bytes.data(), archive.bytes.size());
}

} // namespace

bool mesh_border_glb(const MeshParts *parts, MeshSink *sink, void *user)
{
    try {
        tinygltf::Model model;
        SinkStream      bytes(sink, user);
        std::ostream    stream(&bytes);
        model.asset.version   = "2.0";
        model.asset.generator = "krs";
        model.buffers.resize(1);
        model.scenes.resize(1);
        model.defaultScene = 0;
        add_materials(model, parts);
        for (size_t i = 0; i < parts->part_count; i++)
            add_part(model, parts, parts->parts[i]);
        return tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true) &&
               stream.good();
    } catch (...) {
        return false;
    }
}

bool mesh_border_3mf(const MeshParts *parts, MeshSink *sink, void *user)
{
    try {
        Model model;
        check(NMR::lib3mf_createmodel(model.place()));
        add_objects(parts, model);
        return write_model(model, sink, user);
    } catch (...) {
        return false;
    }
}
