// mesh_3mf.cpp: the border to lib3mf.
#include "cli/mesh_border.h"

#include <cstring>
#include <string>
#include <vector>

#include <Model/COM/NMR_DLLInterfaces.h>

namespace
{

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
    Thing  *give()
    {
        Thing *given = thing;
        thing        = nullptr;
        return given;
    }
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

// A mirrored part is its image in the plane x = 0.
void put_in_geometry(const MeshParts *parts, const MeshPart &part, bool mirrored,
                     NMR::PLib3MFModelMeshObject *object)
{
    std::vector<NMR::MODELMESHVERTEX>   vertices(part.vertex_count);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(part.triangle_count);
    for (size_t i = 0; i < part.vertex_count; i++)
        for (int k = 0; k < 3; k++)
            vertices[i].m_fPosition[k] = (float)((mirrored && k == 0 ? -1 : 1) * parts->scale *
                                                 parts->vertices[part.first_vertex + i][k]);
    for (size_t i = 0; i < part.triangle_count; i++)
        for (int k = 0; k < 3; k++)
            triangles[i].m_nIndices[k] =
                parts->triangles[part.first_triangle + i][mirrored && k > 0 ? 3 - k : k] -
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

// The model that is written, and its materials.
struct Writing {
    const MeshParts     *parts;
    const Model         &model;
    std::vector<DWORD>   numbers;
    NMR::ModelResourceID group;
};

typedef Owned<NMR::PLib3MFModelMeshObject>       MeshObject;
typedef Owned<NMR::PLib3MFModelComponentsObject> ComponentsObject;

void put_in_part(const Writing &writing, const MeshPart &part, bool mirrored, const char *name,
                 MeshObject &object)
{
    check(NMR::lib3mf_model_addmeshobject(writing.model, object.place()));
    check(NMR::lib3mf_object_setnameutf8(object, name));
    put_in_geometry(writing.parts, part, mirrored, object);
    paint(writing.parts, part, object, writing.group, writing.numbers);
}

void build(const Writing &writing, NMR::PLib3MFModelObjectResource *object)
{
    Owned<NMR::PLib3MFModelBuildItem> item;
    check(NMR::lib3mf_model_addbuilditem(writing.model, object, nullptr, item.place()));
}

// Items of an assembly as objects: as they are, and as their image in the plane x = 0.  By that no
// transform is a reflection.
struct Objects {
    std::vector<bool>                              wanted[2];
    std::vector<NMR::PLib3MFModelObjectResource *> made[2];
};

// The transform of a placed item, of whose image in x = 0 where `mirrored` is set; then *image says
// whether it is its own image that is placed.
void find_transform(const double matrix[3][4], bool mirrored, double scale,
                    NMR::MODELTRANSFORM &transform, bool *image)
{
    *image = mesh_is_reflection(matrix) != mirrored;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            double sign               = (mirrored && i == 0 ? -1 : 1) * (*image && k == 0 ? -1 : 1);
            transform.m_fFields[i][k] = (float)(sign * (k == 3 ? scale : 1) * matrix[i][k]);
        }
}

void find_wanted(const KrsAssembly *assembly, Objects &objects)
{
    for (auto &wanted : objects.wanted)
        wanted.assign(assembly->item_count, false);
    objects.wanted[0][assembly->item_count - 1] = true;
    for (size_t n = assembly->item_count; n-- > 0;)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            const KrsItem &item = assembly->items[n];
            for (size_t i = item.first; i < item.first + item.count; i++) {
                bool image = mesh_is_reflection(assembly->placings[i].matrix) != (mirrored != 0);
                if (objects.wanted[mirrored][n])
                    objects.wanted[image][assembly->placings[i].item] = true;
            }
        }
}

NMR::PLib3MFModelObjectResource *add_components(const Writing &writing, const MeshBody &body,
                                                size_t number, bool mirrored,
                                                const Objects &objects)
{
    const KrsItem                     &item = body.assembly->items[number];
    NMR::PLib3MFModelComponentsObject *object;
    bool                               any = false;
    for (size_t i = item.first; i < item.first + item.count; i++)
        for (const auto &made : objects.made)
            any = any || made[body.assembly->placings[i].item];
    if (!any)
        return nullptr; // all meshes in it are empty
    check(NMR::lib3mf_model_addcomponentsobject(writing.model, &object));
    for (size_t i = item.first; i < item.first + item.count; i++) {
        const KrsPlacing                 &placing = body.assembly->placings[i];
        Owned<NMR::PLib3MFModelComponent> component;
        NMR::MODELTRANSFORM               transform;
        bool                              image;
        find_transform(placing.matrix, mirrored, writing.parts->scale, transform, &image);
        if (objects.made[image][placing.item])
            check(NMR::lib3mf_componentsobject_addcomponent(
                object, objects.made[image][placing.item], &transform, component.place()));
    }
    return object;
}

NMR::PLib3MFModelObjectResource *add_item(const Writing &writing, const MeshBody &body,
                                          size_t number, bool mirrored, const Objects &objects)
{
    if (!body.assembly->items[number].mesh)
        return add_components(writing, body, number, mirrored, objects);
    const MeshPart &part = writing.parts->parts[body.part_of[number]];
    MeshObject      object;
    if (part.triangle_count == 0)
        return nullptr;
    put_in_part(writing, part, mirrored, body.name, object);
    return object.give();
}

void add_assembly(const Writing &writing, const MeshBody &body)
{
    const KrsAssembly *assembly = body.assembly;
    Objects            objects;
    find_wanted(assembly, objects);
    for (auto &made : objects.made)
        made.assign(assembly->item_count, nullptr);
    for (size_t n = 0; n < assembly->item_count; n++)
        for (int mirrored = 0; mirrored < 2; mirrored++)
            if (objects.wanted[mirrored][n])
                objects.made[mirrored][n] = add_item(writing, body, n, mirrored != 0, objects);
    NMR::PLib3MFModelObjectResource *all = objects.made[0][assembly->item_count - 1];
    check(NMR::lib3mf_object_setnameutf8(all, body.name));
    build(writing, all);
    for (auto &made : objects.made)
        for (NMR::PLib3MFModelObjectResource *object : made)
            if (object)
                NMR::lib3mf_release(object);
}

void add_objects(const MeshParts *parts, const Model &model)
{
    Writing writing = {parts, model, std::vector<DWORD>(parts->material_count), 0};
    writing.group   = add_base_materials(parts, model, writing.numbers);
    check(NMR::lib3mf_model_setunit(model, unit_of(parts->unit)));
    for (size_t i = 0; i < parts->body_count; i++) {
        const MeshBody &body = parts->bodies[i];
        MeshObject      object;
        if (body.assembly) {
            add_assembly(writing, body);
            continue;
        }
        put_in_part(writing, parts->parts[body.first_part], false, body.name, object);
        build(writing, object);
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
