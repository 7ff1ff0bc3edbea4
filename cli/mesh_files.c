/* mesh_files.c: binary STL, binary PLY with colours, and OBJ; GLB and 3MF by mesh_border.cpp. */
#include "cli/mesh_files.h"

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

static bool add_vector(MeshFile *file, const double vector[3], double scale)
{
    return add_float(file, scale * vector[0]) && add_float(file, scale * vector[1]) &&
           add_float(file, scale * vector[2]);
}

/* ---- STL ---- */

static void corners_of(const MeshFile *file, size_t triangle, const double *corners[3])
{
    for (int i = 0; i < 3; i++)
        corners[i] = file->parts->vertices[file->parts->triangles[triangle][i]];
}

/* STL has no numbers of vertices: those that are equal in single precision are one. */
static bool are_one(const MeshFile *file, const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        if ((float)(file->parts->scale * a[k]) != (float)(file->parts->scale * b[k]))
            return false;
    return true;
}

static bool has_area(const MeshFile *file, size_t triangle)
{
    const double *corners[3];
    corners_of(file, triangle, corners);
    return !are_one(file, corners[0], corners[1]) && !are_one(file, corners[1], corners[2]) &&
           !are_one(file, corners[2], corners[0]);
}

static bool add_stl_triangle(MeshFile *file, size_t triangle)
{
    static const uint16_t nothing = 0;
    const double         *corners[3];
    double                edges[2][3], normal[3];
    corners_of(file, triangle, corners);
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    normalize3(normal);
    return add_vector(file, normal, 1) && add_vector(file, corners[0], file->parts->scale) &&
           add_vector(file, corners[1], file->parts->scale) &&
           add_vector(file, corners[2], file->parts->scale) &&
           add_bytes(file, &nothing, sizeof nothing);
}

static bool write_stl(MeshFile *file)
{
    char     header[80] = "binary STL, made by krs";
    uint32_t count      = 0;
    for (size_t i = 0; i < file->triangle_count; i++)
        count += has_area(file, i);
    if (!add_bytes(file, header, sizeof header) || !add_word(file, count))
        return false;
    for (size_t i = 0; i < file->triangle_count; i++)
        if (has_area(file, i) && !add_stl_triangle(file, i))
            return false;
    return true;
}

/* ---- PLY ---- */

static bool write_ply(MeshFile *file)
{
    const MeshParts *parts = file->parts;
    if (!add_line(file,
                  "ply\nformat binary_little_endian 1.0\ncomment made by krs\n"
                  "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n",
                  file->vertex_count) ||
        !add_line(file, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "element face ") ||
        !add_line(file, "%zu\nproperty list uchar uint vertex_indices\nend_header\n",
                  file->triangle_count))
        return false;
    for (size_t i = 0; i < file->vertex_count; i++)
        if (!add_vector(file, parts->vertices[i], file->parts->scale) ||
            !add_bytes(file, parts->colors[i], sizeof parts->colors[i]))
            return false;
    for (size_t i = 0; i < file->triangle_count; i++)
        if (!add_bytes(file, "\3", 1) || !add_word(file, parts->triangles[i][0]) ||
            !add_word(file, parts->triangles[i][1]) || !add_word(file, parts->triangles[i][2]))
            return false;
    return true;
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

static bool add_obj_faces(MeshFile *file, const MeshPart *part, uint32_t material)
{
    const MeshParts *parts = file->parts;
    bool             named = parts->material_count == 1;
    for (size_t i = part->first_triangle; i < part->first_triangle + part->triangle_count; i++) {
        const uint32_t *triangle = parts->triangles[i];
        if (parts->material_of[i] != material)
            continue;
        if (!named && !add_obj_name(file, "usemtl", parts->materials[material].name))
            return false;
        named = true;
        if (!add_line(file, "f %u %u %u\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1))
            return false;
    }
    return true;
}

static bool add_obj_part(MeshFile *file, const MeshPart *part)
{
    if (file->parts->part_count > 1 && !add_obj_name(file, "o", part->name))
        return false;
    for (uint32_t i = 0; i < file->parts->material_count; i++)
        if (!add_obj_faces(file, part, i))
            return false;
    return true;
}

static bool write_obj(MeshFile *file)
{
    const MeshParts *parts = file->parts;
    if (!add_line(file, "# made by krs\n"))
        return false;
    for (size_t i = 0; i < file->vertex_count; i++) {
        const double        *at    = parts->vertices[i];
        const unsigned char *color = parts->colors[i];
        if (!add_line(file, "v %.9g %.9g %.9g %.4g %.4g %.4g\n", file->parts->scale * at[0],
                      file->parts->scale * at[1], file->parts->scale * at[2], color[0] / 255.0,
                      color[1] / 255.0, color[2] / 255.0))
            return false;
    }
    for (size_t i = 0; i < parts->part_count; i++)
        if (!add_obj_part(file, &parts->parts[i]))
            return false;
    return true;
}

/* ---- all formats ---- */

static bool take_bytes(void *user, const void *bytes, size_t count)
{
    MeshFile *file = user;
    return output_append(file->file, bytes, count);
}

static bool write_glb(MeshFile *file) { return mesh_border_glb(file->parts, take_bytes, file); }
static bool write_3mf(MeshFile *file) { return mesh_border_3mf(file->parts, take_bytes, file); }

static const MeshFormat formats[] = {{".stl", false, false, write_stl},
                                     {".ply", false, false, write_ply},
                                     {".obj", true, false, write_obj},
                                     {".glb", true, true, write_glb},
                                     {".3mf", true, true, write_3mf}};

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
