/*
 * looks.c: the materials of triangles.
 *
 * A file with looks has a material for each look of each material of the scene: what its properties are but for the
 * color, which vertices have.  One with colours of triangles has one for each of these.  A material that varies has more than
 * a file needs: it becomes their mean.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "cli/mesh/meshing.h"
#include "compiler/base/vec.h"

enum { PROBES = 256, MAX_LOOKS = 8, LOOK_NUMBERS = sizeof(MeshLook) / sizeof(double) };
/* Parts of a property by which looks of triangles differ. */
static const double MIN_DIFFERENCE = 1e-3;

/* The properties, and which numbers of a look they are. */
typedef struct Property {
    const char *name;
    size_t      first, count;
} Property;

static const Property properties[] = {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    {#name, offsetof(MeshLook, name) / sizeof(double),                         \
     sizeof(((MeshLook *)0)->name) / sizeof(double)},
#include "krs/surface.def"
};
enum { PROPERTIES = sizeof properties / sizeof *properties };

static MeshLook look_of(const KrsHit *hit)
{
    MeshLook look;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    memcpy(&look.name, &hit->name, sizeof look.name);
#include "krs/surface.def"
    return look;
}

static bool is_property(const Property *property, size_t offset)
{
    return property->first == offset / sizeof(double);
}

/* Tells whether vertices (colors), corners (tangents) or pictures (the rest, if there are any) have
   the property. */
static bool is_told_elsewhere(const Property *property, bool baked)
{
    return is_property(property, offsetof(MeshLook, color)) ||
           is_property(property, offsetof(MeshLook, tangent)) ||
           (baked && (is_property(property, offsetof(MeshLook, roughness)) ||
                      is_property(property, offsetof(MeshLook, metallic)) ||
                      is_property(property, offsetof(MeshLook, emission))));
}

static bool differs(const MeshLook *a, const MeshLook *b, const Property *property)
{
    const double *x = (const double *)a + property->first;
    const double *y = (const double *)b + property->first;
    for (size_t i = 0; i < property->count; i++)
        if (!(fabs(x[i] - y[i]) <= MIN_DIFFERENCE * fmax(1, fabs(x[i]))))
            return true;
    return false;
}

static bool is_same_look(const MeshLook *a, const MeshLook *b, bool baked)
{
    for (size_t i = 0; i < PROPERTIES; i++)
        if (!is_told_elsewhere(&properties[i], baked) && differs(a, b, &properties[i]))
            return false;
    return true;
}

/* ---- groups of triangles ---- */

/* Triangles of about one look and one material of the scene. */
typedef struct Group {
    MeshLook      first, low, high;
    double        sum[LOOK_NUMBERS], area; /* the sum is of each number times the area */
    unsigned char color[3];
    uint32_t      number; /* of the material */
    uint32_t      next;   /* of the same material, from 1 */
} Group;

typedef struct Groups {
    Arena    *arena;
    bool      by_name, by_look, by_color, baked;
    uint32_t *of_number; /* from 1: the first group of a material */
    bool     *varies;    /* of materials: they have too many looks */
    struct {
        Group *items;
        size_t count, capacity;
    } list;
} Groups;

static void find_color(const KrsHit *hit, unsigned char color[3])
{
    for (int k = 0; k < 3; k++)
        color[k] = color_byte(hit->color[k]);
}

static bool is_of(const Groups *groups, const Group *group, const KrsHit *hit, const MeshLook *look)
{
    unsigned char color[3];
    find_color(hit, color);
    return (!groups->by_look || is_same_look(&group->first, look, groups->baked)) &&
           (!groups->by_color || memcmp(group->color, color, sizeof color) == 0);
}

static uint32_t add_group(Groups *groups, const KrsHit *hit, const MeshLook *look, uint32_t number)
{
    Group group = {.first = *look, .low = *look, .high = *look, .number = number};
    find_color(hit, group.color);
    array_push(groups->arena, &groups->list, group);
    return (uint32_t)groups->list.count;
}

/* Finds the group of a point; the last group of a material takes what does not fit into the
   others. */
static uint32_t find_group(Groups *groups, const KrsHit *hit, const MeshLook *look)
{
    uint32_t number = groups->by_name ? hit->material : 0, length = 0, last = 0;
    for (uint32_t i = groups->of_number[number]; i != 0; i = groups->list.items[i - 1].next) {
        if (is_of(groups, &groups->list.items[i - 1], hit, look))
            return i - 1;
        last = i;
        length++;
    }
    if (length >= MAX_LOOKS) {
        groups->varies[number] = true;
        return last - 1;
    }
    uint32_t added = add_group(groups, hit, look, number);
    if (last == 0)
        groups->of_number[number] = added;
    else
        groups->list.items[last - 1].next = added;
    return added - 1;
}

static uint32_t take_triangle(Groups *groups, const KrsHit *hit, double area)
{
    MeshLook look   = look_of(hit);
    uint32_t number = find_group(groups, hit, &look);
    Group   *group  = &groups->list.items[number];
    double  *low = (double *)&group->low, *high = (double *)&group->high;
    group->area += area;
    for (size_t i = 0; i < LOOK_NUMBERS; i++) {
        double value = ((const double *)&look)[i];
        group->sum[i] += area * value;
        low[i]  = fmin(low[i], value);
        high[i] = fmax(high[i], value);
    }
    return number;
}

/* Makes all groups of a material that varies the first one. */
static void merge_groups(Groups *groups, uint32_t *new_numbers)
{
    for (size_t i = 0; i < groups->list.count; i++) {
        Group   *group = &groups->list.items[i];
        uint32_t head  = groups->of_number[group->number] - 1;
        new_numbers[i] = groups->varies[group->number] ? head : (uint32_t)i;
        Group *into    = &groups->list.items[new_numbers[i]];
        if (into == group)
            continue;
        into->area += group->area;
        for (size_t k = 0; k < LOOK_NUMBERS; k++) {
            double *low = (double *)&into->low + k, *high = (double *)&into->high + k;
            into->sum[k] += group->sum[k];
            *low  = fmin(*low, ((const double *)&group->low)[k]);
            *high = fmax(*high, ((const double *)&group->high)[k]);
        }
    }
}

/* ---- triangles ---- */

static double area_of(const double (*points)[3], const uint32_t triangle[3])
{
    double along[3], across[3], cross[3];
    add_scaled3(along, points[triangle[1]], -1, points[triangle[0]]);
    add_scaled3(across, points[triangle[2]], -1, points[triangle[0]]);
    cross3(along, across, cross);
    return 0.5 * length3(cross);
}

void mesh_middle(const MeshParts *parts, size_t triangle, double middle[3])
{
    for (int k = 0; k < 3; k++) {
        middle[k] = 0;
        for (int i = 0; i < 3; i++)
            middle[k] += parts->in_scene[parts->triangles[triangle][i]][k] / 3;
    }
}

static void group_triangles(const Meshing *meshing, const MeshParts *parts, Groups *groups,
                            uint32_t *of)
{
    size_t count = parts_triangle_count(parts);
    double middles[PROBES][3];
    KrsHit hits[PROBES];
    for (size_t i = 0, now; i < count; i += now) {
        now = count - i < PROBES ? count - i : PROBES;
        for (size_t t = 0; t < now; t++)
            mesh_middle(parts, i + t, middles[t]);
        krs_probe(meshing->state, (const double(*)[3])middles, now, hits);
        for (size_t t = 0; t < now; t++)
            of[i + t] = take_triangle(groups, &hits[t],
                                      area_of(parts->in_scene, parts->triangles[i + t]));
    }
}

/* ---- materials ---- */

/* Returns the name of a group, which is its color where that was painted. */
static const char *name_of(const Meshing *meshing, const Group *group, bool even)
{
    const char *name  = krs_material_name(meshing->scene, group->number);
    Text        color = {.arena = meshing->options->arena};
    if (!name || strcmp(name, PLAIN_COLOR) != 0 || !even)
        return name;
    text_format(&color, "#%02x%02x%02x", group->color[0], group->color[1], group->color[2]);
    return color.bytes;
}

static bool has_one_color(const Group *group)
{
    return memcmp(group->low.color, group->high.color, sizeof group->low.color) == 0;
}

/* Returns the material of a group.  Properties that do not vary are those of the scene, without the
   rounding of a mean. */
static MeshMaterial material_of(const Meshing *meshing, const Groups *groups, const Group *group)
{
    bool         even     = has_one_color(group) && !groups->varies[group->number];
    const char  *name     = groups->by_name ? name_of(meshing, group, even) : NULL;
    MeshMaterial material = {.name = name ? name : "material", .look = group->first};
    for (size_t i = 0; i < PROPERTIES; i++)
        if (group->area > 0 && differs(&group->low, &group->high, &properties[i]))
            for (size_t k = properties[i].first; k < properties[i].first + properties[i].count; k++)
                ((double *)&material.look)[k] = group->sum[k] / group->area;
    memcpy(material.color, group->color, sizeof material.color);
    material.varies = groups->varies[group->number];
    material.even   = even;
    return material;
}

static void warn_of_means(const Meshing *meshing, const char *path, const Group *group)
{
    Text        varying = {.arena = meshing->options->arena};
    const char *name    = krs_material_name(meshing->scene, group->number);
    for (size_t i = 0; i < PROPERTIES; i++)
        if (!is_told_elsewhere(&properties[i], meshing->options->mesh_bake > 0) &&
            differs(&group->low, &group->high, &properties[i]))
            text_format(&varying, "%s`%s`", varying.length ? ", " : "", properties[i].name);
    say("warning: in `%s` the material `%s` has the same %s everywhere, the mean of what it has in "
        "the scene",
        path, name ? name : "material", varying.bytes);
}

static void warn_of_none(const Meshing *meshing, const char *path, const MeshMaterial *materials,
                         size_t count, const char *property, bool (*changes)(const MeshLook *look))
{
    Text        named = {.arena = meshing->options->arena};
    const char *last  = NULL;
    for (size_t i = 0; i < count; i++) {
        if (!changes(&materials[i].look) || (last && strcmp(last, materials[i].name) == 0))
            continue;
        last = materials[i].name;
        text_format(&named, "%s`%s`", named.length ? ", " : "", last);
    }
    if (named.length > 0)
        say("warning: `%s` is without the `%s` of %s: glTF has nothing like it", path, property,
            named.bytes);
}

#define GLTF_NONE(property, when) \
    static bool changes_by_##property(const MeshLook *look) { return when; }
#include "cli/mesh/gltf_fields.def"

static void warn_of_looks(const Meshing *meshing, const char *path, const Groups *groups,
                          const MeshMaterial *materials, size_t count)
{
    for (size_t i = 0; i < groups->list.count; i++)
        if (groups->varies[groups->list.items[i].number] &&
            groups->of_number[groups->list.items[i].number] == i + 1)
            warn_of_means(meshing, path, &groups->list.items[i]);
#define GLTF_NONE(property, when) \
    warn_of_none(meshing, path, materials, count, #property, changes_by_##property);
#include "cli/mesh/gltf_fields.def"
}

/* ---- how thick glass is ---- */

/* Connected surfaces. */
typedef struct Shells {
    uint32_t *above;         /* of vertices: the one before in the same surface, or itself */
    double   *volume, *area; /* of the surface, at the vertex that is itself */
} Shells;

static uint32_t shell_of(const Shells *shells, uint32_t vertex)
{
    while (shells->above[vertex] != vertex) {
        shells->above[vertex] = shells->above[shells->above[vertex]];
        vertex                = shells->above[vertex];
    }
    return vertex;
}

static void join_shells(Arena *arena, const MeshParts *parts, Shells *shells)
{
    size_t vertices = parts_vertex_count(parts), triangles = parts_triangle_count(parts);
    shells->above = arena_alloc(arena, vertices, sizeof *shells->above);
    for (uint32_t i = 0; i < vertices; i++)
        shells->above[i] = i;
    for (size_t t = 0; t < triangles; t++)
        for (int k = 1; k < 3; k++)
            shells->above[shell_of(shells, parts->triangles[t][k])] = shell_of(
                shells, parts->triangles[t][0]);
}

const uint32_t *mesh_shells(Arena *arena, const MeshParts *parts)
{
    Shells shells = {0};
    join_shells(arena, parts, &shells);
    for (uint32_t i = 0; i < parts_vertex_count(parts); i++)
        shells.above[i] = shell_of(&shells, i);
    return shells.above;
}

static void find_shells(Arena *arena, const MeshParts *parts, Shells *shells)
{
    size_t vertices = parts_vertex_count(parts), triangles = parts_triangle_count(parts);
    join_shells(arena, parts, shells);
    shells->volume = arena_new_array(arena, double, vertices);
    shells->area   = arena_new_array(arena, double, vertices);
    for (size_t t = 0; t < triangles; t++) {
        const uint32_t *corners = parts->triangles[t];
        uint32_t        shell   = shell_of(shells, corners[0]);
        double          a[3], b[3], c[3], cross[3];
        add_scaled3(a, parts->vertices[corners[0]], -1, parts->vertices[shell]);
        add_scaled3(b, parts->vertices[corners[1]], -1, parts->vertices[shell]);
        add_scaled3(c, parts->vertices[corners[2]], -1, parts->vertices[shell]);
        cross3(b, c, cross);
        shells->volume[shell] += dot3(a, cross) / 6;
        shells->area[shell] += area_of(parts->vertices, corners);
    }
}

/* Returns the mean length of ways through the solids of a material: 4 V / S, by Cauchy for convex
   ones and by Santalo for all. */
static double mean_way(Arena *arena, const MeshParts *parts, const Shells *shells, uint32_t number)
{
    char  *seen   = arena_new_array(arena, char, parts_vertex_count(parts));
    double volume = 0, area = 0;
    for (size_t t = 0; t < parts_triangle_count(parts); t++) {
        uint32_t shell = shell_of(shells, parts->triangles[t][0]);
        if (parts->material_of[t] != number || seen[shell])
            continue;
        seen[shell] = 1;
        volume += shells->volume[shell];
        area += shells->area[shell];
    }
    return area > 0 ? 4 * fabs(volume) / area : 0;
}

static void find_thicknesses(Arena *arena, const MeshParts *parts, MeshMaterial *materials)
{
    Shells shells = {0};
    for (uint32_t i = 0; i < parts->material_count; i++) {
        if (materials[i].look.transmission <= 0)
            continue;
        if (!shells.above)
            find_shells(arena, parts, &shells);
        materials[i].thickness = mean_way(arena, parts, &shells, i);
    }
}

void find_materials(const Meshing *meshing, const MeshFormat *format, const char *path,
                    MeshParts *parts)
{
    Arena    *arena  = meshing->options->arena;
    size_t    known  = krs_material_count(meshing->scene) + 2;
    bool      split  = meshing->options->mesh_split == SPLIT_MATERIALS;
    Groups    groups = {.arena     = arena,
                        .by_name   = format->has_looks || format->has_face_colors || split,
                        .by_look   = format->has_looks,
                        .baked     = format->has_looks && meshing->options->mesh_bake > 0,
                        .by_color  = format->has_face_colors,
                        .of_number = arena_new_array(arena, uint32_t, known),
                        .varies    = arena_new_array(arena, bool, known)};
    uint32_t *of     = arena_new_array(arena, uint32_t, parts_triangle_count(parts));
    group_triangles(meshing, parts, &groups, of);
    uint32_t     *heads     = arena_new_array(arena, uint32_t, groups.list.count + 1);
    uint32_t     *numbers   = arena_new_array(arena, uint32_t, groups.list.count + 1);
    MeshMaterial *materials = arena_new_array(arena, MeshMaterial, groups.list.count + 1);
    merge_groups(&groups, heads);
    for (size_t i = 0; i < groups.list.count; i++)
        if (heads[i] == i) {
            numbers[i]                         = (uint32_t)parts->material_count;
            materials[parts->material_count++] = material_of(meshing, &groups,
                                                             &groups.list.items[i]);
        }
    for (size_t t = 0; t < parts_triangle_count(parts); t++)
        of[t] = numbers[heads[of[t]]];
    parts->material_of = of;
    parts->materials   = materials;
    if (!format->has_looks)
        return;
    find_thicknesses(arena, parts, materials);
    if (!meshing->options->quiet)
        warn_of_looks(meshing, path, &groups, materials, parts->material_count);
}
