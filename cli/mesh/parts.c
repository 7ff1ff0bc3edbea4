/*
 * parts.c: what files have of meshes: parts with names, colours and materials.
 */
#include <math.h>
#include <string.h>

#include "cli/mesh/meshing.h"
#include "compiler/base/srgb.h"

void visit_meshes(const Body *body, VisitMesh *visit, void *user)
{
    if (body->mesh)
        visit(user, body->mesh, NULL);
    for (size_t i = 0; body->assembly && i < body->assembly->item_count; i++)
        if (body->assembly->items[i].mesh)
            visit(user, body->assembly->items[i].mesh, &body->assembly->items[i]);
}

/* ---- one behind the other ---- */

typedef struct Joined {
    MeshParts parts;
    double (*vertices)[3];
    double (*places)[3]; /* of the vertices in the scene */
    uint32_t (*triangles)[3];
    MeshPart *list;
    MeshBody *bodies;
    size_t    vertex_count, triangle_count;
} Joined;

static void count_mesh(void *user, const KrsMesh *mesh, const KrsItem *item)
{
    Joined *joined = user;
    (void)item;
    joined->vertex_count += mesh->vertex_count;
    joined->triangle_count += mesh->triangle_count;
    joined->parts.part_count++;
}

static void place(const KrsItem *item, const double point[3], double image[3])
{
    for (int i = 0; i < 3; i++)
        image[i] = item ? item->first_copy[i][0] * point[0] + item->first_copy[i][1] * point[1] +
                              item->first_copy[i][2] * point[2] + item->first_copy[i][3]
                        : point[i];
}

static void join_mesh(void *user, const KrsMesh *mesh, const KrsItem *item)
{
    Joined *joined = user;
    size_t  vertex = joined->vertex_count, triangle = joined->triangle_count;
    joined->list[joined->parts.part_count++] = (MeshPart){
        vertex,
        mesh->vertex_count,
        triangle,
        mesh->triangle_count,
        item ? (const double(*)[4])item->first_copy : NULL,
        mesh->steps};
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        memcpy(joined->vertices[vertex + i], mesh->vertices[i], sizeof *joined->vertices);
        place(item, mesh->vertices[i], joined->places[vertex + i]);
    }
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            joined->triangles[triangle + t][k] = mesh->triangles[t][k] + (uint32_t)vertex;
    joined->vertex_count += mesh->vertex_count;
    joined->triangle_count += mesh->triangle_count;
}

static const char *body_name(const Meshing *meshing, const Body *body)
{
    KrsComponent component;
    if (body->component == 0)
        return scene_name(meshing->options->arena, meshing->options->files.items[0]);
    krs_component(meshing->scene, body->component - 1, &component);
    return component.name;
}

static void join_body(const Meshing *meshing, const Body *body, Joined *joined)
{
    size_t  items   = body->assembly ? body->assembly->item_count : 0;
    size_t *part_of = arena_new_array(meshing->options->arena, size_t, items + 1);
    size_t  part    = joined->parts.part_count;
    for (size_t i = 0; i < items; i++)
        part_of[i] = body->assembly->items[i].mesh ? part++ : 0;
    joined->bodies[joined->parts.body_count++] = (MeshBody){.name       = body_name(meshing, body),
                                                            .assembly   = body->assembly,
                                                            .part_of    = part_of,
                                                            .first_part = joined->parts.part_count,
                                                            .lod_count  = body->lod_count};
    take_beams(meshing, body, &joined->bodies[joined->parts.body_count - 1]);
    visit_meshes(body, join_mesh, joined);
    for (size_t i = 0; i < body->lod_count; i++)
        join_mesh(joined, body->lods[i], NULL);
}

static bool has_anything(const Body *body)
{
    if (body->beam_count > 0)
        return true;
    return body->assembly ? body->assembly->triangles > 0 : body->mesh->triangle_count > 0;
}

static void count_body(const Body *body, Joined *joined)
{
    visit_meshes(body, count_mesh, joined);
    for (size_t i = 0; i < body->lod_count; i++)
        count_mesh(joined, body->lods[i], NULL);
}

static void join_bodies(const Meshing *meshing, const Bodies *bodies, Joined *joined)
{
    Arena *arena = meshing->options->arena;
    for (size_t i = 0; i < bodies->count; i++)
        count_body(&bodies->items[i], joined);
    joined->vertices       = arena_alloc(arena, joined->vertex_count, sizeof *joined->vertices);
    joined->places         = arena_alloc(arena, joined->vertex_count, sizeof *joined->places);
    joined->triangles      = arena_alloc(arena, joined->triangle_count, sizeof *joined->triangles);
    joined->list           = arena_new_array(arena, MeshPart, joined->parts.part_count);
    joined->bodies         = arena_new_array(arena, MeshBody, bodies->count);
    joined->vertex_count   = 0;
    joined->triangle_count = 0;
    joined->parts.part_count = 0;
    for (size_t i = 0; i < bodies->count; i++)
        if (has_anything(&bodies->items[i]))
            join_body(meshing, &bodies->items[i], joined);
    joined->parts.vertices  = (const double(*)[3])joined->vertices;
    joined->parts.triangles = (const uint32_t(*)[3])joined->triangles;
    joined->parts.parts     = joined->list;
    joined->parts.bodies    = joined->bodies;
}

/* ---- looks ---- */

unsigned char color_byte(double linear)
{
    return (unsigned char)lrint(255 * fmin(fmax(srgb_of_linear(linear), 0), 1));
}

enum { PROBES = 256 };

static void find_colors(const Meshing *meshing, Joined *joined)
{
    unsigned char(*colors)[3] = arena_alloc(meshing->options->arena, joined->vertex_count,
                                            sizeof *colors);
    KrsHit hits[PROBES];
    for (size_t i = 0, now; i < joined->vertex_count; i += now) {
        now = joined->vertex_count - i < PROBES ? joined->vertex_count - i : PROBES;
        krs_probe(meshing->state, (const double(*)[3])joined->places + i, now, hits);
        for (size_t k = 0; k < 3 * now; k++)
            colors[i + k / 3][k % 3] = color_byte(hits[k / 3].color[k % 3]);
    }
    joined->parts.colors = (const unsigned char(*)[3])colors;
}

static void find_middles(const MeshParts *parts, size_t first, size_t count, double (*middles)[3])
{
    for (size_t t = 0; t < count; t++)
        mesh_middle(parts, first + t, middles[t]);
}

/* Finds the colors at the corners of triangles; a vertex may have several. */
static void find_corner_colors(const Meshing *meshing, const MeshPart *part, MeshParts *parts,
                               unsigned char (*colors)[3][3])
{
    KrsHit hits[PROBES];
    double middles[PROBES][3];
    size_t end = part->first_triangle + part->triangle_count;
    for (size_t i = part->first_triangle, now; i < end; i += now) {
        now = end - i < PROBES ? end - i : PROBES;
        find_middles(parts, i, now, middles);
        if (part->steps)
            krs_probe(meshing->state, (const double(*)[3])middles, now, hits);
        for (size_t k = 0; k < 3 * now; k++) {
            unsigned char *color = colors[i + k / 3][k % 3];
            memcpy(color, parts->colors[parts->triangles[i + k / 3][k % 3]], 3);
            for (int c = 0; c < 3 && part->steps; c++)
                color[c] = color_byte(hits[k / 3].color[c]);
        }
    }
}

static void find_all_corner_colors(const Meshing *meshing, MeshParts *parts)
{
    unsigned char(*colors)[3][3] = NULL;
    for (size_t i = 0; i < parts->part_count; i++)
        if (parts->parts[i].steps && !colors)
            colors = arena_alloc(meshing->options->arena, parts_triangle_count(parts),
                                 sizeof *colors);
    for (size_t i = 0; colors && i < parts->part_count; i++)
        find_corner_colors(meshing, &parts->parts[i], parts, colors);
    parts->corner_colors = (const unsigned char(*)[3][3])colors;
}

/* Returns the number of vertices of all parts, which lie one behind the other. */
size_t parts_vertex_count(const MeshParts *parts)
{
    size_t count = 0;
    for (size_t i = 0; i < parts->part_count; i++)
        count += parts->parts[i].vertex_count;
    return count;
}

size_t parts_triangle_count(const MeshParts *parts)
{
    size_t count = 0;
    for (size_t i = 0; i < parts->part_count; i++)
        count += parts->parts[i].triangle_count;
    return count;
}

void find_parts(const Meshing *meshing, const Bodies *bodies, MeshParts *parts)
{
    Joined joined = {.parts = {.scale = meshing->scale}};
    join_bodies(meshing, bodies, &joined);
    joined.parts.in_scene = (const double(*)[3])joined.places;
    find_colors(meshing, &joined);
    find_all_corner_colors(meshing, &joined.parts);
    *parts = joined.parts;
}

/* ---- without copies ---- */

typedef struct Flat {
    const MeshParts *from;
    double (*vertices)[3];
    unsigned char (*colors)[3];
    uint32_t (*triangles)[3];
    uint32_t *material_of;
    unsigned char (*corner_colors)[3][3];
    double (*corner_places)[3][2];
    MeshFrame (*corner_frames)[3];
    size_t vertex_count, triangle_count;
} Flat;

static bool count_copy(void *user, const MeshCopy *copy)
{
    Flat *flat = user;
    flat->vertex_count += copy->part->vertex_count;
    flat->triangle_count += copy->part->triangle_count;
    return true;
}

static bool flatten_copy(void *user, const MeshCopy *copy)
{
    Flat            *flat = user;
    const MeshParts *from = flat->from;
    const MeshPart  *part = copy->part;
    size_t           base = flat->vertex_count;
    for (size_t i = 0; i < part->vertex_count; i++) {
        mesh_copy_vertex(from, copy, i, flat->vertices[base + i]);
        memcpy(flat->colors[base + i], from->colors[part->first_vertex + i], sizeof *flat->colors);
    }
    for (size_t t = 0; t < part->triangle_count; t++) {
        mesh_copy_triangle(from, copy, t, base, flat->triangles[flat->triangle_count + t]);
        flat->material_of[flat->triangle_count + t] = from->material_of[part->first_triangle + t];
        if (from->corner_colors)
            mesh_copy_colors(from, copy, t, flat->corner_colors[flat->triangle_count + t]);
        if (from->corner_places)
            mesh_copy_places(from, copy, t, flat->corner_places[flat->triangle_count + t]);
        if (from->corner_frames)
            mesh_copy_frames(from, copy, t, flat->corner_frames[flat->triangle_count + t]);
    }
    return count_copy(flat, copy);
}

void flatten_parts(const Meshing *meshing, MeshParts *parts)
{
    Arena    *arena  = meshing->options->arena;
    Flat      flat   = {.from = parts};
    MeshPart *list   = arena_new_array(arena, MeshPart, parts->body_count);
    MeshBody *bodies = arena_new_array(arena, MeshBody, parts->body_count);
    for (size_t i = 0; i < parts->body_count; i++)
        mesh_body_visit(parts, i, count_copy, &flat);
    flat.vertices    = arena_alloc(arena, flat.vertex_count, sizeof *flat.vertices);
    flat.colors      = arena_alloc(arena, flat.vertex_count, sizeof *flat.colors);
    flat.triangles   = arena_alloc(arena, flat.triangle_count, sizeof *flat.triangles);
    flat.material_of = arena_new_array(arena, uint32_t, flat.triangle_count);
    if (parts->corner_colors)
        flat.corner_colors = arena_alloc(arena, flat.triangle_count, sizeof *flat.corner_colors);
    if (parts->corner_places)
        flat.corner_places = arena_alloc(arena, flat.triangle_count, sizeof *flat.corner_places);
    if (parts->corner_frames)
        flat.corner_frames = arena_alloc(arena, flat.triangle_count, sizeof *flat.corner_frames);
    flat.vertex_count = flat.triangle_count = 0;
    for (size_t i = 0; i < parts->body_count; i++) {
        MeshPart part = {.first_vertex = flat.vertex_count, .first_triangle = flat.triangle_count};
        mesh_body_visit(parts, i, flatten_copy, &flat);
        part.vertex_count   = flat.vertex_count - part.first_vertex;
        part.triangle_count = flat.triangle_count - part.first_triangle;
        list[i]             = part;
        bodies[i]           = (MeshBody){.name = parts->bodies[i].name, .first_part = i};
    }
    parts->vertices      = (const double(*)[3])flat.vertices;
    parts->colors        = (const unsigned char(*)[3])flat.colors;
    parts->triangles     = (const uint32_t(*)[3])flat.triangles;
    parts->material_of   = flat.material_of;
    parts->corner_colors = (const unsigned char(*)[3][3])flat.corner_colors;
    parts->corner_places = (const double(*)[3][2])flat.corner_places;
    parts->corner_frames = (const MeshFrame(*)[3])flat.corner_frames;
    parts->parts         = list;
    parts->bodies        = bodies;
    parts->part_count    = parts->body_count;
}

/* ---- units ---- */

/* The lengths of units in metres, in the order of unit_choices. */
const double metres_of_units[] = {1e-3, 1e-6, 1e-2, 1, 0.0254, 0.3048};

/* Sets the units of the file; without an option, those that its format usually has. */
void set_units(const Meshing *meshing, const MeshFormat *format, MeshParts *parts)
{
    int unit = meshing->options->mesh_units;
    if (unit < 0)
        unit = find_choice(strcmp(format->ending, ".glb") == 0 ? "m" : "mm", unit_choices);
    parts->unit   = unit_choices[unit].name;
    parts->metres = metres_of_units[unit];
}
