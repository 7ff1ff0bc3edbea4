/* files.c: binary STL, binary PLY with colours, and OBJ; GLB and 3MF by bridge.h. */
#include "cli/mesh/files.h"

#include <endian.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "compiler/base/vec.h"

enum { LONGEST_LINE = 256 };

/* ---- bytes ---- */

static bool flush(MeshFile *file)
{
    bool written = output_append(file->file, file->buffer, file->length);
    file->length = 0;
    return written;
}

static bool add_bytes(MeshFile *file, const void *bytes, size_t length)
{
    if (file->length + length > sizeof file->buffer && !flush(file))
        return false;
    memcpy(file->buffer + file->length, bytes, length);
    file->length += length;
    return true;
}

__attribute__((format(printf, 2, 3))) static bool add_line(MeshFile *file, const char *format, ...)
{
    char    line[LONGEST_LINE];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return add_bytes(file, line, (size_t)length);
}

static bool add_word(MeshFile *file, uint32_t word)
{
    word = htole32(word);
    return add_bytes(file, &word, sizeof word);
}

static bool add_float(MeshFile *file, double number)
{
    float    single = (float)number;
    uint32_t word;
    memcpy(&word, &single, sizeof word);
    return add_word(file, word);
}

static bool add_vector(MeshFile *file, const double vector[3])
{
    return add_float(file, vector[0]) && add_float(file, vector[1]) && add_float(file, vector[2]);
}

/* ---- copies ---- */

static bool visit_copies(MeshFile *file, VisitMeshCopy *visit)
{
    file->base = 0;
    for (file->body = 0; file->body < file->parts->body_count; file->body++)
        if (!mesh_body_visit(file->parts, file->body, visit, file))
            return false;
    return true;
}

/* Finds a vertex in the lengths of the file. */
static void vertex_of(const MeshFile *file, const MeshCopy *copy, size_t number, double at[3])
{
    mesh_copy_vertex(file->parts, copy, number, at);
    for (int k = 0; k < 3; k++)
        at[k] *= file->parts->scale;
}

/* ---- STL ---- */

/* Tells whether two vertices are equal in single precision, and so are one: STL has no numbers of
   vertices. */
static bool are_one(const double a[3], const double b[3])
{
    return (float)a[0] == (float)b[0] && (float)a[1] == (float)b[1] && (float)a[2] == (float)b[2];
}

/* Finds the corners of a triangle; false: it has no area in single precision. */
static bool find_corners(const MeshFile *file, const MeshCopy *copy, size_t number,
                         double corners[3][3])
{
    uint32_t triangle[3];
    mesh_copy_triangle(file->parts, copy, number, 0, triangle);
    for (int i = 0; i < 3; i++)
        vertex_of(file, copy, triangle[i], corners[i]);
    return !are_one(corners[0], corners[1]) && !are_one(corners[1], corners[2]) &&
           !are_one(corners[2], corners[0]);
}

static bool add_stl_triangle(MeshFile *file, const double corners[3][3])
{
    static const uint16_t nothing = 0;
    double                edges[2][3], normal[3];
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    normalize3(normal);
    return add_vector(file, normal) && add_vector(file, corners[0]) &&
           add_vector(file, corners[1]) && add_vector(file, corners[2]) &&
           add_bytes(file, &nothing, sizeof nothing);
}

static bool count_stl(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    double    corners[3][3];
    for (size_t i = 0; i < copy->part->triangle_count; i++)
        file->triangle_count += find_corners(file, copy, i, corners);
    return true;
}

static bool add_stl_copy(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    double    corners[3][3];
    for (size_t i = 0; i < copy->part->triangle_count; i++)
        if (find_corners(file, copy, i, corners) &&
            !add_stl_triangle(file, (const double(*)[3])corners))
            return false;
    return true;
}

static bool write_stl(MeshFile *file)
{
    char header[80]      = "binary STL, made by krs";
    file->triangle_count = 0;
    visit_copies(file, count_stl);
    return add_bytes(file, header, sizeof header) &&
           add_word(file, (uint32_t)file->triangle_count) && visit_copies(file, add_stl_copy);
}

/* ---- PLY ---- */

static bool count_vertices(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    file->vertex_count += copy->part->vertex_count;
    return true;
}

static bool add_ply_vertices(void *user, const MeshCopy *copy)
{
    MeshFile        *file  = user;
    const MeshParts *parts = file->parts;
    for (size_t i = 0; i < copy->part->vertex_count; i++) {
        size_t number = copy->part->first_vertex + i;
        double at[3];
        vertex_of(file, copy, i, at);
        if (!add_vector(file, at) || !add_bytes(file, parts->colors[number], 3))
            return false;
        if (parts->vertex_places && (!add_float(file, parts->vertex_places[number][0]) ||
                                     !add_float(file, parts->vertex_places[number][1])))
            return false;
    }
    return true;
}

static bool add_ply_faces(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    uint32_t  triangle[3];
    for (size_t i = 0; i < copy->part->triangle_count; i++) {
        mesh_copy_triangle(file->parts, copy, i, file->base, triangle);
        if (!add_bytes(file, "\3", 1) || !add_word(file, triangle[0]) ||
            !add_word(file, triangle[1]) || !add_word(file, triangle[2]))
            return false;
    }
    file->base += copy->part->vertex_count;
    return true;
}

/* Writes a PLY file, in which vertices on seams of a texture occur for each side. */
static bool write_ply(MeshFile *file)
{
    file->vertex_count = 0;
    visit_copies(file, count_vertices);
    return add_line(file,
                    "ply\nformat binary_little_endian 1.0\ncomment made by krs\n"
                    "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n",
                    file->vertex_count) &&
           add_line(file,
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n%s"
                    "element face ",
                    file->parts->vertex_places ? "property float s\nproperty float t\n" : "") &&
           add_line(file, "%zu\nproperty list uchar uint vertex_indices\nend_header\n",
                    file->triangle_count) &&
           visit_copies(file, add_ply_vertices) && visit_copies(file, add_ply_faces);
}

/* ---- OBJ ---- */

/* Names have no blanks there. */
static bool add_obj_name(MeshFile *file, const char *what, const char *name)
{
    char word[LONGEST_LINE / 2];
    snprintf(word, sizeof word, "%s", name);
    for (char *at = word; *at; at++)
        if (*at == ' ')
            *at = '_';
    return add_line(file, "%s %s\n", what, word);
}

static bool add_obj_vertices(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    for (size_t i = 0; i < copy->part->vertex_count; i++) {
        const unsigned char *color = file->parts->colors[copy->part->first_vertex + i];
        double               at[3];
        vertex_of(file, copy, i, at);
        if (!add_line(file, "v %.9g %.9g %.9g %.4g %.4g %.4g\n", at[0], at[1], at[2],
                      color[0] / 255.0, color[1] / 255.0, color[2] / 255.0))
            return false;
    }
    return true;
}

/* Adds a line for a place of a corner, unless the vertex has the same from the triangle before. */
static bool add_obj_place(MeshFile *file, uint32_t vertex, const double place[2])
{
    ObjPlace *last = &file->places[vertex];
    if (last->number > 0 && last->at[0] == place[0] && last->at[1] == place[1])
        return true;
    *last = (ObjPlace){{place[0], place[1]}, ++file->place_count};
    return add_line(file, "vt %.9g %.9g\n", place[0], place[1]);
}

/* Adds a face of OBJ; `triangle` has numbers of vertices in the file. */
static bool add_obj_face(MeshFile *file, const MeshCopy *copy, size_t number,
                         const uint32_t triangle[3])
{
    const uint32_t *t = triangle;
    uint32_t        n[3];
    double          places[3][2];
    if (!file->parts->corner_places)
        return add_line(file, "f %u %u %u\n", t[0], t[1], t[2]);
    mesh_copy_places(file->parts, copy, number, places);
    for (int k = 0; k < 3; k++) {
        uint32_t vertex = (uint32_t)(t[k] - file->base - 1 + copy->part->first_vertex);
        if (!add_obj_place(file, vertex, places[k]))
            return false;
        n[k] = file->places[vertex].number;
    }
    return add_line(file, "f %u/%u %u/%u %u/%u\n", t[0], n[0], t[1], n[1], t[2], n[2]);
}

static bool add_obj_faces(MeshFile *file, const MeshCopy *copy, uint32_t material)
{
    const MeshParts *parts = file->parts;
    for (size_t i = 0; i < copy->part->triangle_count; i++) {
        uint32_t triangle[3];
        if (parts->material_of[copy->part->first_triangle + i] != material)
            continue;
        if (file->material != material &&
            !add_obj_name(file, "usemtl", parts->materials[material].name))
            return false;
        file->material = material;
        mesh_copy_triangle(parts, copy, i, file->base + 1, triangle);
        if (!add_obj_face(file, copy, i, triangle))
            return false;
    }
    return true;
}

static bool add_obj_copy(void *user, const MeshCopy *copy)
{
    MeshFile *file = user;
    for (uint32_t i = 0; i < file->parts->material_count; i++)
        if (!add_obj_faces(file, copy, i))
            return false;
    file->base += copy->part->vertex_count;
    return true;
}

/* Writes an OBJ file; a body or material alone has no name. */
static bool write_obj(MeshFile *file)
{
    const MeshParts *parts = file->parts;
    if (!add_line(file, "# made by krs\n") || !visit_copies(file, add_obj_vertices))
        return false;
    file->base = 0;
    for (size_t i = 0; i < parts->body_count; i++) {
        file->material = parts->material_count == 1 ? 0 : UINT32_MAX;
        if (parts->body_count > 1 && !add_obj_name(file, "o", parts->bodies[i].name))
            return false;
        if (!mesh_body_visit(parts, i, add_obj_copy, file))
            return false;
    }
    return true;
}

/* ---- all formats ---- */

static bool take_bytes(void *user, const void *bytes, size_t count)
{
    MeshFile *file = user;
    return output_append(file->file, bytes, count);
}

static bool write_glb(MeshFile *file) { return mesh_bridge_glb(file->parts, take_bytes, file); }
static bool write_3mf(MeshFile *file) { return mesh_bridge_3mf(file->parts, take_bytes, file); }

/* Numbers of 24 bits, and of nine digits. */
static const double SINGLE = 5.9604645e-8, NINE_DIGITS = 5e-9;

static const MeshFormat formats[] = {
    {".stl", .write = write_stl, .rounding = SINGLE},
    {".ply", .has_colors = true, .has_places = true, .places_of_vertices = true, .write = write_ply,
     .rounding = SINGLE},
    {".obj", .has_colors = true, .has_parts = true, .has_places = true, .write = write_obj,
     .rounding = NINE_DIGITS},
    {".glb", true, true, true, true, true, true, false, false, true, true, write_glb, SINGLE},
    {".3mf", .has_beams = true, .has_colors = true, .has_parts = true, .has_copies = true,
     .has_face_colors = true, .write = write_3mf, .rounding = NINE_DIGITS}};

const MeshFormat *mesh_format(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot, formats[i].ending) == 0)
            return &formats[i];
    return NULL;
}

bool mesh_file_write(MeshFile *file, const MeshFormat *format)
{
    return format->write(file) && flush(file);
}
