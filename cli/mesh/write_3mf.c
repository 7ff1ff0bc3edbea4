/*
 * write_3mf.c: 3MF, an archive of three files in XML: what there is, where the model is, and the model, by
 * the core specification 1.3.  Where the color of a material varies triangles have those of their corners, by the
 * materials extension 1.2.1; beams are those of the beam lattice extension 1.0 (2017/02).  It has neither times nor
 * random names: equal meshes are equal files.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/mesh/bridge.h"
#include "cli/pack/archive.h"
#include "compiler/base/vec.h"

#define XML "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"

static const char types[] = XML
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n";
static const char relationships[] = XML
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
    "<Relationship Id=\"model\" Target=\"/3D/3dmodel.model\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
    "</Relationships>\n";

/* ---- the model ---- */

/* The numbers of the materials and of the colors; objects have those that follow, in the order of the file. */
enum { MATERIALS = 1, COLORS };

typedef struct Model {
    FILE            *out; /* remembers that it failed */
    const MeshParts *parts;
    size_t           last; /* number of an object */
    uint32_t *colors;      /* of corners of triangles whose material varies, each once, ascending */
    size_t    color_count;
} Model;

/* Writes text within quotes, without the characters that XML does not have. */
static void put_text(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&': fputs("&amp;", out); break;
        case '<': fputs("&lt;", out); break;
        case '"': fputs("&quot;", out); break;
        default:
            if ((unsigned char)*text >= ' ')
                fputc(*text, out);
        }
}

static const char *unit_name(const char *unit)
{
    static const char *const names[][2] = {
        {"um", "micron"}, {"cm", "centimeter"}, {"m", "meter"}, {"in", "inch"}, {"ft", "foot"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(unit, names[i][0]) == 0)
            return names[i][1];
    return "millimeter";
}

static void put_materials(const Model *model)
{
    fprintf(model->out, "<basematerials id=\"%d\">\n", MATERIALS);
    for (size_t i = 0; i < model->parts->material_count; i++) {
        const MeshMaterial *material = &model->parts->materials[i];
        fputs("<base name=\"", model->out);
        put_text(model->out, material->name);
        fprintf(model->out, "\" displaycolor=\"#%02X%02X%02XFF\"/>\n", material->color[0],
                material->color[1], material->color[2]);
    }
    fputs("</basematerials>\n", model->out);
}

/* ---- colors of corners ---- */

static uint32_t color_of(const MeshParts *parts, size_t triangle, int corner)
{
    const unsigned char *c = mesh_corner_color(parts, triangle, corner);
    return (uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | c[2];
}

static int compare_colors(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static bool varies(const MeshParts *parts, size_t triangle)
{
    return parts->materials[parts->material_of[triangle]].varies;
}

/* Returns false if memory has run out. */
static bool find_colors(Model *model)
{
    const MeshParts *parts = model->parts;
    size_t           count = 0, end = 0, kept = 0;
    for (size_t i = 0; i < parts->part_count; i++)
        end += parts->parts[i].triangle_count;
    for (size_t t = 0; t < end; t++)
        count += varies(parts, t) ? 3 : 0;
    model->colors = calloc(count + 1, sizeof *model->colors);
    if (!model->colors)
        return false;
    count = 0;
    for (size_t t = 0; t < end; t++)
        for (int k = 0; k < 3 && varies(parts, t); k++)
            model->colors[count++] = color_of(parts, t, k);
    qsort(model->colors, count, sizeof *model->colors, compare_colors);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || model->colors[i] != model->colors[i - 1])
            model->colors[kept++] = model->colors[i];
    model->color_count = kept;
    return true;
}

static void put_colors(const Model *model)
{
    if (model->color_count == 0)
        return;
    fprintf(model->out, "<m:colorgroup id=\"%d\">\n", COLORS);
    for (size_t i = 0; i < model->color_count; i++)
        fprintf(model->out, "<m:color color=\"#%06XFF\"/>\n", model->colors[i]);
    fputs("</m:colorgroup>\n", model->out);
}

static size_t color_number(const Model *model, size_t triangle, int corner)
{
    const uint32_t  color = color_of(model->parts, triangle, corner);
    const uint32_t *found = bsearch(&color, model->colors, model->color_count, sizeof color,
                                    compare_colors);
    return (size_t)(found - model->colors);
}

/* ---- objects ---- */

static void open_object(Model *model, const char *name)
{
    fprintf(model->out, "<object id=\"%zu\" type=\"model\"", ++model->last);
    if (name) {
        fputs(" name=\"", model->out);
        put_text(model->out, name);
        fputc('"', model->out);
    }
}

static void put_vertices(const Model *model, const MeshPart *part, bool mirrored)
{
    fputs("<vertices>\n", model->out);
    for (size_t i = 0; i < part->vertex_count; i++) {
        const double *at    = model->parts->vertices[part->first_vertex + i];
        const double  scale = model->parts->scale;
        fprintf(model->out, "<vertex x=\"%.9g\" y=\"%.9g\" z=\"%.9g\"/>\n",
                (float)((mirrored ? -1 : 1) * scale * at[0]), (float)(scale * at[1]),
                (float)(scale * at[2]));
    }
    fputs("</vertices>\n", model->out);
}

/* Triangles name their material where it is not the object's, and colors where that varies. */
static void put_triangles(const Model *model, const MeshPart *part, bool mirrored, uint32_t usual)
{
    const MeshParts *parts = model->parts;
    fputs("<triangles>\n", model->out);
    for (size_t i = part->first_triangle; i < part->first_triangle + part->triangle_count; i++) {
        const size_t    first  = part->first_vertex;
        const int       second = mirrored ? 2 : 1, third = mirrored ? 1 : 2;
        const uint32_t *corners = parts->triangles[i];
        fprintf(model->out, "<triangle v1=\"%zu\" v2=\"%zu\" v3=\"%zu\"", corners[0] - first,
                corners[second] - first, corners[third] - first);
        if (varies(parts, i))
            fprintf(model->out, " pid=\"%d\" p1=\"%zu\" p2=\"%zu\" p3=\"%zu\"", COLORS,
                    color_number(model, i, 0), color_number(model, i, second),
                    color_number(model, i, third));
        else if (parts->material_of[i] != usual)
            fprintf(model->out, " pid=\"%d\" p1=\"%u\"", MATERIALS, parts->material_of[i]);
        fputs("/>\n", model->out);
    }
    fputs("</triangles>\n", model->out);
}

/* Writes a mesh; a mirrored one is its image in the plane x = 0.  Returns its number; 0: it is
   empty. */
static size_t put_part(Model *model, const MeshPart *part, bool mirrored, const char *name)
{
    if (part->triangle_count == 0)
        return 0;
    const uint32_t usual = model->parts->material_of[part->first_triangle];
    open_object(model, name);
    fprintf(model->out, " pid=\"%d\" pindex=\"%u\">\n<mesh>\n", MATERIALS, usual);
    put_vertices(model, part, mirrored);
    put_triangles(model, part, mirrored, usual);
    fputs("</mesh>\n</object>\n", model->out);
    return model->last;
}

/* ---- beams ---- */

static void put_number(const Model *model, const char *name, double number)
{
    fprintf(model->out, " %s=\"%.9g\"", name, (float)(model->parts->scale * number));
}

/* Returns the length below which the specification has no beam. */
static double min_length(const MeshBody *body)
{
    double least = HUGE_VAL;
    for (size_t i = 0; i < body->beam_count; i++)
        least = fmin(least, distance3(body->beams[i].ends[0], body->beams[i].ends[1]));
    return 0.5 * least;
}

/* An end of a beam, and its vertex. */
typedef struct End {
    const double *at;
    size_t        number; /* twice that of the beam, + 1 for the second end */
} End;

static int compare_ends(const void *a, const void *b)
{
    const End *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->at[k] != y->at[k])
            return x->at[k] < y->at[k] ? -1 : 1;
    return 0;
}

static void put_end(const Model *model, const double at[3])
{
    fputs("<vertex", model->out);
    put_number(model, "x", at[0]);
    put_number(model, "y", at[1]);
    put_number(model, "z", at[2]);
    fputs("/>\n", model->out);
}

/* Ends at one place are one vertex; `vertices` are those of ends. */
static void put_ends(const Model *model, const MeshBody *body, End *ends, size_t *vertices)
{
    const size_t count  = 2 * body->beam_count;
    size_t       vertex = 0;
    for (size_t i = 0; i < count; i++)
        ends[i] = (End){body->beams[i / 2].ends[i % 2], i};
    qsort(ends, count, sizeof *ends, compare_ends);
    fputs("<vertices>\n", model->out);
    for (size_t i = 0; i < count; i++) {
        const bool again = i > 0 && compare_ends(&ends[i - 1], &ends[i]) == 0;
        vertex += i > 0 && !again;
        vertices[ends[i].number] = vertex;
        if (!again)
            put_end(model, ends[i].at);
    }
    fputs("</vertices>\n<triangles/>\n", model->out);
}

static void put_beams(const Model *model, const MeshBody *body, const size_t *vertices)
{
    fputs("<b:beamlattice", model->out);
    put_number(model, "radius", body->beams[0].radii[0]);
    put_number(model, "minlength", min_length(body));
    fputs(" cap=\"sphere\" clippingmode=\"none\">\n<b:beams>\n", model->out);
    for (size_t i = 0; i < body->beam_count; i++) {
        fprintf(model->out, "<b:beam v1=\"%zu\" v2=\"%zu\"", vertices[2 * i], vertices[2 * i + 1]);
        put_number(model, "r1", body->beams[i].radii[0]);
        put_number(model, "r2", body->beams[i].radii[1]);
        fputs("/>\n", model->out);
    }
    fputs("</b:beams>\n</b:beamlattice>\n", model->out);
}

/* Writes an object of beams with round ends, and a material of its own.  False: memory has run
   out. */
static bool put_lattice(Model *model, const MeshBody *body, size_t *built)
{
    const size_t         material = ++model->last;
    const unsigned char *color    = body->color;
    End                 *ends     = calloc(2 * body->beam_count, sizeof *ends);
    size_t              *vertices = calloc(2 * body->beam_count, sizeof *vertices);
    const bool           good     = ends && vertices;
    if (good) {
        fprintf(model->out,
                "<basematerials id=\"%zu\">\n<base name=\"beams\" "
                "displaycolor=\"#%02X%02X%02XFF\"/>\n</basematerials>\n",
                material, color[0], color[1], color[2]);
        open_object(model, body->name);
        fprintf(model->out, " pid=\"%zu\" pindex=\"0\">\n<mesh>\n", material);
        put_ends(model, body, ends, vertices);
        put_beams(model, body, vertices);
        fputs("</mesh>\n</object>\n", model->out);
        *built = model->last;
    }
    free(ends);
    free(vertices);
    return good;
}

/* ---- copies ---- */

/* An item of an assembly as it is, and as its image in the plane x = 0.  So no transform has to be a
   reflection. */
typedef struct ItemObjects {
    bool   wanted[2];
    size_t made[2]; /* numbers of objects; 0: none */
} ItemObjects;

typedef struct Copies {
    Model          *model;
    const MeshBody *body;
    ItemObjects    *objects;
} Copies;

static void find_wanted(const KrsAssembly *assembly, ItemObjects *objects)
{
    objects[assembly->item_count - 1].wanted[0] = true;
    for (size_t n = assembly->item_count; n-- > 0;)
        for (int mirrored = 0; mirrored < 2; mirrored++)
            for (size_t i = 0; objects[n].wanted[mirrored] && i < assembly->items[n].count; i++) {
                const KrsTransform *transform = &assembly->transforms[assembly->items[n].first + i];
                const bool image = mesh_is_reflection(transform->matrix) != (mirrored != 0);
                objects[transform->item].wanted[image] = true;
            }
}

/* Writes a placed item, of whose image in x = 0 where `mirrored` is set. */
static void put_component(const Copies *copies, const KrsTransform *transform, bool mirrored)
{
    const bool   image  = mesh_is_reflection(transform->matrix) != mirrored;
    const size_t object = copies->objects[transform->item].made[image];
    const Model *model  = copies->model;
    if (object == 0)
        return;
    fprintf(model->out, "<component objectid=\"%zu\" transform=\"", object);
    for (int k = 0; k < 4; k++) /* rows of the file are columns */
        for (int i = 0; i < 3; i++) {
            const double sign  = (mirrored && i == 0 ? -1 : 1) * (image && k == 0 ? -1 : 1);
            const double scale = k == 3 ? model->parts->scale : 1;
            fprintf(model->out, "%s%.9g", k + i > 0 ? " " : "",
                    (float)(sign * scale * transform->matrix[i][k]));
        }
    fputs("\"/>\n", model->out);
}

static bool has_components(const Copies *copies, const KrsItem *item)
{
    for (size_t i = item->first; i < item->first + item->count; i++) {
        const size_t *made = copies->objects[copies->body->assembly->transforms[i].item].made;
        if (made[0] || made[1])
            return true;
    }
    return false;
}

/* Returns its number; 0: all meshes in it are empty. */
static size_t put_item(const Copies *copies, size_t number, bool mirrored)
{
    const MeshBody *body = copies->body;
    const KrsItem  *item = &body->assembly->items[number];
    const bool      all  = number == body->assembly->item_count - 1;
    if (item->mesh)
        return put_part(copies->model, &copies->model->parts->parts[body->part_of[number]],
                        mirrored, item->name ? item->name : body->name);
    if (!has_components(copies, item))
        return 0;
    open_object(copies->model, all ? body->name : NULL);
    fputs(">\n<components>\n", copies->model->out);
    for (size_t i = item->first; i < item->first + item->count; i++)
        put_component(copies, &body->assembly->transforms[i], mirrored);
    fputs("</components>\n</object>\n", copies->model->out);
    return copies->model->last;
}

/* Returns false if memory has run out. */
static bool put_assembly(Model *model, const MeshBody *body, size_t *built)
{
    const KrsAssembly *assembly = body->assembly;
    Copies             copies   = {model, body, calloc(assembly->item_count, sizeof(ItemObjects))};
    if (!copies.objects)
        return false;
    find_wanted(assembly, copies.objects);
    for (size_t n = 0; n < assembly->item_count; n++)
        for (int mirrored = 0; mirrored < 2; mirrored++)
            if (copies.objects[n].wanted[mirrored])
                copies.objects[n].made[mirrored] = put_item(&copies, n, mirrored != 0);
    *built = copies.objects[assembly->item_count - 1].made[0];
    free(copies.objects);
    return true;
}

static bool has_beams(const MeshParts *parts)
{
    for (size_t i = 0; i < parts->body_count; i++)
        if (parts->bodies[i].beam_count > 0)
            return true;
    return false;
}

/* Writes the model; `built` has room for the number of each body's object. */
static bool put_model(Model *model, size_t *built)
{
    const MeshParts *parts = model->parts;
    fprintf(model->out,
            XML "<model unit=\"%s\" xml:lang=\"en-US\" "
                "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"%s%s>\n"
                "<metadata name=\"Application\">krs " KRS_VERSION "</metadata>\n<resources>\n",
            unit_name(parts->unit),
            model->color_count == 0
                ? ""
                : " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"",
            has_beams(parts) ? " xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/"
                               "beamlattice/2017/02\" requiredextensions=\"b\""
                             : "");
    if (parts->material_count > 0)
        put_materials(model);
    put_colors(model);
    for (size_t i = 0; i < parts->body_count; i++) {
        const MeshBody *body = &parts->bodies[i];
        if (body->beam_count > 0 && !put_lattice(model, body, &built[i]))
            return false;
        if (body->beam_count > 0)
            continue;
        if (!body->assembly)
            built[i] = put_part(model, &parts->parts[body->first_part], false, body->name);
        else if (!put_assembly(model, body, &built[i]))
            return false;
    }
    fputs("</resources>\n<build>\n", model->out);
    for (size_t i = 0; i < parts->body_count; i++)
        if (built[i] > 0)
            fprintf(model->out, "<item objectid=\"%zu\"/>\n", built[i]);
    fputs("</build>\n</model>\n", model->out);
    return true;
}

/* Returns the model's text, which the caller frees; NULL: memory has run out. */
static char *model_text(const MeshParts *parts, size_t *length)
{
    char   *text  = NULL;
    size_t *built = calloc(parts->body_count + 1, sizeof *built);
    Model   model = {.parts = parts, .out = open_memstream(&text, length), .last = COLORS};
    bool    good  = built && model.out && find_colors(&model) && put_model(&model, built) &&
                !ferror(model.out);
    if (model.out && fclose(model.out) != 0)
        good = false;
    free(built);
    free(model.colors);
    if (!good) {
        free(text);
        text = NULL;
    }
    return text;
}

bool mesh_bridge_3mf(const MeshParts *parts, MeshSink *sink, void *user)
{
    size_t            length;
    char             *model   = model_text(parts, &length);
    const ArchiveFile files[] = {{"[Content_Types].xml", types, strlen(types)},
                                 {"_rels/.rels", relationships, strlen(relationships)},
                                 {"3D/3dmodel.model", model, length}};
    const bool        good    = model && archive_write(files, 3, sink, user);
    free(model);
    return good;
}
