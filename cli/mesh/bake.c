/*
 * bake.c: materials that vary, as pictures.
 *
 * Each pixel of an atlas is a point of a triangle, and it is given the material of the nearest point of the surface.  Only
 * then it is known which materials vary; if many do not, their triangles leave the atlas, and the others have it all.
 */
#include <math.h>
#include <png.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/mesh/atlas.h"
#include "cli/mesh/meshing.h"
#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"

enum { PROBES = 256 };
/* Points nearer than this part of the mesh's error are on the surface. */
static const double ON_SURFACE = 1e-3;
/* The length by which a pixel beyond an edge is moved into the triangle: in pixels, and of the way
   to the middle. */
static const double INTO = 0.02, MAX_INTO = 1e-3;
/* The same emission, relatively. */
static const double SAME_EMISSION = 1e-3;

/* The others leave the atlas where no more than this part of it is left. */
static const double MAX_BAKED_TWICE = 0.75;
/* Materials of one color each that one may be; more are a picture. */
enum { MAX_EVEN = 16 };
static const uint32_t NONE = UINT32_MAX;

/* The properties of a pixel, as in pictures. */
typedef struct Texel {
    unsigned char color[3], roughness, metallic;
    float         emission[3];
} Texel;

/* The least and the greatest properties of several pixels. */
typedef struct Spread {
    size_t count, first; /* the first pixel */
    Texel  low, high;
} Spread;

/* The triangles of a connected surface that have one material of looks.c; or those of a material of the file. */
typedef struct Piece {
    uint32_t material, triangle; /* the latter: one of them */
    uint32_t next;               /* of the same surface; NONE: there are no more */
    bool     mixed;              /* of a file: it may vary */
    Spread   spread;
} Piece;

typedef struct Pieces {
    Piece *items;
    size_t count, capacity;
} Pieces;

typedef struct Baking {
    const Meshing *meshing;
    MeshParts     *parts;
    Atlas          atlas;
    KrsState      *states[MAX_PARTS];
    double         error;
    Texel         *texels;
    uint32_t      *piece_of;      /* of triangles */
    Pieces         pieces, rows;  /* rows: materials of the file */
    MeshMaterial  *materials;     /* of rows */
    uint32_t      *row_of;        /* of triangles */
    atomic_size_t  next;          /* row of pixels */
    atomic_bool    failed, ended; /* ended: nobody wants it any more */
} Baking;

/* ---- points ---- */

/* Finds where a pixel is on its triangle, in the scene. */
static void point_of(const Baking *b, size_t pixel, double point[3])
{
    const uint32_t triangle = b->atlas.owner[pixel], *corners = b->parts->triangles[triangle];
    const double(*c)[2]    = (const double(*)[2])b->atlas.corners[triangle];
    const double center[2] = {(double)(pixel % b->atlas.side) + 0.5,
                              (double)(pixel / b->atlas.side) + 0.5};
    double       weights[3];
    const double away = atlas_nearest(c, center, weights);
    const double size = fmax(hypot(c[1][0] - c[0][0], c[1][1] - c[0][1]),
                             hypot(c[2][0] - c[0][0], c[2][1] - c[0][1]));
    const double into = away > 0 ? fmin(INTO / fmax(size, INTO), MAX_INTO) : 0;
    memset(point, 0, 3 * sizeof *point);
    for (int k = 0; k < 3; k++)
        add_scaled3(point, point, weights[k] + into * (1.0 / 3 - weights[k]),
                    b->parts->in_scene[corners[k]]);
}

static Texel texel_of(const KrsHit *hit)
{
    Texel texel     = {.metallic = (unsigned char)lrint(255 * hit->metallic)};
    texel.roughness = (unsigned char)lrint(
        255 * glb_roughness(hit->roughness, hit->specular_roughness_anisotropy));
    for (int k = 0; k < 3; k++) {
        texel.color[k]    = color_byte(hit->color[k]);
        texel.emission[k] = (float)hit->emission[k];
    }
    return texel;
}

/* The surface is nearest along the gradient. */
static KrsStatus move_to_surface(const Baking *b, KrsState *state, double (*points)[3],
                                 size_t count)
{
    double    distances[PROBES], off[PROBES][3], normals[PROBES][3];
    size_t    which[PROBES], moved = 0;
    KrsStatus status = krs_distance(state, (const double(*)[3])points, count, distances);
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        double away = fabs(distances[i]);
        if (away <= ON_SURFACE * b->error || away > b->error)
            continue;
        memcpy(off[moved], points[i], sizeof off[moved]);
        which[moved++] = i;
    }
    if (moved > 0 && status == KRS_OK)
        status = krs_normal(state, (const double(*)[3])off, moved, normals);
    for (size_t k = 0; k < moved && status == KRS_OK; k++)
        add_scaled3(points[which[k]], off[k], -distances[which[k]], normals[k]);
    return status;
}

static KrsStatus bake_some(Baking *b, KrsState *state, const size_t *pixels, double (*points)[3],
                           size_t count)
{
    KrsHit    hits[PROBES];
    KrsStatus status = move_to_surface(b, state, points, count);
    if (status == KRS_OK)
        status = krs_probe(state, (const double(*)[3])points, count, hits);
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        b->texels[pixels[i]] = texel_of(&hits[i]);
    return status;
}

static KrsStatus bake_row(Baking *b, KrsState *state, size_t row)
{
    double    points[PROBES][3];
    size_t    pixels[PROBES], count = 0, end = (row + 1) * b->atlas.side;
    KrsStatus status = KRS_OK;
    for (size_t i = end - b->atlas.side; i < end && status == KRS_OK; i++) {
        if (b->atlas.owner[i] != ATLAS_NONE) {
            point_of(b, i, points[count]);
            pixels[count++] = i;
        }
        if (count == PROBES || (i + 1 == end && count > 0)) {
            status = bake_some(b, state, pixels, points, count);
            count  = 0;
        }
    }
    return status;
}

static void bake_rows(void *task, size_t part, size_t parts)
{
    Baking *b = task;
    (void)parts;
    while (!atomic_load(&b->failed) && !atomic_load(&b->ended)) {
        if (part == 0)
            atomic_store(&b->ended, !mesh_is_wanted(b->meshing));
        size_t row = atomic_fetch_add(&b->next, 1);
        if (row >= b->atlas.side)
            return;
        if (bake_row(b, b->states[part], row) != KRS_OK)
            atomic_store(&b->failed, true);
    }
}

/* ---- which materials vary ---- */

static void widen(Spread *spread, size_t pixel, const Texel *texel)
{
    if (spread->count++ == 0) {
        spread->first = pixel;
        spread->low = spread->high = *texel;
    }
    for (int k = 0; k < 3; k++) {
        spread->low.color[k]     = min2(spread->low.color[k], texel->color[k]);
        spread->high.color[k]    = max2(spread->high.color[k], texel->color[k]);
        spread->low.emission[k]  = fminf(spread->low.emission[k], texel->emission[k]);
        spread->high.emission[k] = fmaxf(spread->high.emission[k], texel->emission[k]);
    }
    spread->low.roughness  = min2(spread->low.roughness, texel->roughness);
    spread->high.roughness = max2(spread->high.roughness, texel->roughness);
    spread->low.metallic   = min2(spread->low.metallic, texel->metallic);
    spread->high.metallic  = max2(spread->high.metallic, texel->metallic);
}

static double brightest_of(const Spread *spread)
{
    const float *high = spread->high.emission;
    return fmaxf(high[0], fmaxf(high[1], high[2]));
}

static bool glow_varies(const Spread *spread)
{
    for (int k = 0; k < 3; k++)
        if (spread->high.emission[k] - spread->low.emission[k] >
            SAME_EMISSION * brightest_of(spread))
            return true;
    return false;
}

static void judge(const Spread *spread, bool baked[PICTURES])
{
    const Texel *low = &spread->low, *high = &spread->high;
    baked[PICTURE_COLOR] = memcmp(low->color, high->color, sizeof low->color) != 0;
    baked[PICTURE_GLOSS] = low->roughness != high->roughness || low->metallic != high->metallic;
    baked[PICTURE_GLOW]  = glow_varies(spread);
}

static bool any(const bool baked[PICTURES])
{
    return baked[PICTURE_COLOR] || baked[PICTURE_GLOSS] || baked[PICTURE_GLOW];
}

bool mesh_is_baked(const MeshMaterial *material) { return any(material->baked); }

static uint32_t add_piece(Baking *b, uint32_t material, uint32_t triangle)
{
    Piece piece = {.material = material, .triangle = triangle, .next = NONE};
    array_push(b->meshing->options->arena, &b->pieces, piece);
    return (uint32_t)b->pieces.count - 1;
}

static void find_pieces(Baking *b)
{
    Arena          *arena    = b->meshing->options->arena;
    const uint32_t *shells   = mesh_shells(arena, b->parts);
    size_t          vertices = parts_vertex_count(b->parts), count = parts_triangle_count(b->parts);
    uint32_t       *first = arena_new_array(arena, uint32_t, vertices);
    b->piece_of           = arena_new_array(arena, uint32_t, count);
    memset(first, 0xff, vertices * sizeof *first);
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t material = b->parts->material_of[t];
        uint32_t      *head = &first[shells[b->parts->triangles[t][0]]], number = *head;
        while (number != NONE && b->pieces.items[number].material != material)
            number = b->pieces.items[number].next;
        if (number == NONE) {
            number                       = add_piece(b, material, t);
            b->pieces.items[number].next = *head;
            *head                        = number;
        }
        b->piece_of[t] = number;
    }
}

/* Finds the spread of each piece over all pixels; `of`: the piece that a triangle is of. */
static void find_spreads(Baking *b, Pieces *pieces, const uint32_t *of)
{
    for (size_t i = 0; i < pieces->count; i++)
        pieces->items[i].spread.count = 0;
    for (size_t i = 0; i < (size_t)b->atlas.side * b->atlas.side; i++)
        if (b->atlas.owner[i] != ATLAS_NONE)
            widen(&pieces->items[of[b->atlas.owner[i]]].spread, i, &b->texels[i]);
}

/* ---- materials of the file ---- */

/* Returns a pixel of a piece, or the middle of a triangle that is smaller than all pixels. */
static KrsHit look_at_piece(const Baking *b, const Piece *piece)
{
    double point[3];
    KrsHit hit;
    if (piece->spread.count > 0)
        point_of(b, piece->spread.first, point);
    else
        mesh_middle(b->parts, piece->triangle, point);
    krs_probe(b->meshing->state, (const double(*)[3])point, 1, &hit);
    return hit;
}

/* Takes the material of a piece at a point, except for what pictures show. */
static void take_look(const Baking *b, const Piece *piece, MeshMaterial *material)
{
    KrsHit hit     = look_at_piece(b, piece);
    bool   plain   = material->name[0] == '#' || strcmp(material->name, PLAIN_COLOR) == 0;
    Text   name    = {.arena = b->meshing->options->arena};
    material->even = !material->baked[PICTURE_COLOR];
    memcpy(material->look.color, hit.color, sizeof hit.color);
    memcpy(material->look.emission, hit.emission, sizeof hit.emission);
    material->look.roughness = hit.roughness;
    material->look.metallic  = hit.metallic;
    for (int k = 0; k < 3; k++)
        material->color[k] = color_byte(hit.color[k]);
    text_format(&name, "#%02x%02x%02x", material->color[0], material->color[1], material->color[2]);
    if (plain)
        material->name = material->even ? name.bytes : PLAIN_COLOR;
}

static bool is_same_texel(const Texel *a, const Texel *b)
{
    return memcmp(a->color, b->color, sizeof a->color) == 0 && a->roughness == b->roughness &&
           a->metallic == b->metallic && memcmp(a->emission, b->emission, sizeof a->emission) == 0;
}

/* Finds the row of a piece.  Pieces of one material that vary share a row; of the others equal ones
   do, unless there are many. */
static uint32_t find_row(Baking *b, const Piece *piece, bool mixed)
{
    size_t even = 0;
    for (uint32_t i = 0; i < b->rows.count; i++) {
        const Piece *row = &b->rows.items[i];
        if (row->material != piece->material || row->mixed != mixed)
            continue;
        if (mixed || is_same_texel(&row->spread.low, &piece->spread.low))
            return i;
        even++;
    }
    if (even >= MAX_EVEN)
        return find_row(b, piece, true);
    Piece row = *piece;
    row.mixed = mixed;
    array_push(b->meshing->options->arena, &b->rows, row);
    return (uint32_t)b->rows.count - 1;
}

static void find_rows(Baking *b)
{
    Arena    *arena  = b->meshing->options->arena;
    size_t    count  = parts_triangle_count(b->parts);
    uint32_t *row_of = arena_new_array(arena, uint32_t, b->pieces.count + 1);
    b->row_of        = arena_new_array(arena, uint32_t, count);
    for (size_t i = 0; i < b->pieces.count; i++) {
        Piece *piece = &b->pieces.items[i];
        bool   varies[PICTURES];
        if (piece->spread.count == 0) {
            KrsHit hit        = look_at_piece(b, piece);
            Texel  texel      = texel_of(&hit);
            piece->spread.low = piece->spread.high = texel;
        }
        judge(&piece->spread, varies);
        row_of[i] = find_row(b, piece, any(varies));
    }
    for (size_t t = 0; t < count; t++)
        b->row_of[t] = row_of[b->piece_of[t]];
}

static void make_materials(Baking *b)
{
    Arena        *arena     = b->meshing->options->arena;
    MeshMaterial *materials = arena_new_array(arena, MeshMaterial, b->rows.count + 1);
    find_spreads(b, &b->rows, b->row_of);
    for (size_t i = 0; i < b->rows.count; i++) {
        Piece *row   = &b->rows.items[i];
        materials[i] = b->parts->materials[row->material];
        judge(&row->spread, materials[i].baked);
        take_look(b, row, &materials[i]);
    }
    b->materials             = materials;
    b->parts->materials      = materials;
    b->parts->material_of    = b->row_of;
    b->parts->material_count = b->rows.count;
}

/* ---- all pixels ---- */

/* Finds the length of pixels.  Each level of detail is seen from twice as far, so its pixels are
   twice as long. */
static void find_fineness(const MeshParts *parts, bool all, float *fineness)
{
    for (size_t i = 0; i < parts->body_count; i++) {
        const MeshBody *body = &parts->bodies[i];
        size_t          end  = i + 1 < parts->body_count ? body[1].first_part : parts->part_count;
        for (size_t n = body->first_part; n < end; n++) {
            const MeshPart *part  = &parts->parts[n];
            size_t          level = body->lod_count > 0 ? n - body->first_part : 0;
            for (size_t t = 0; t < part->triangle_count; t++) {
                size_t triangle = part->first_triangle + t;
                bool wanted = all || mesh_is_baked(&parts->materials[parts->material_of[triangle]]);
                fineness[triangle] = wanted ? ldexpf(1, -(int)level) : 0;
            }
        }
    }
}

static KrsStatus bake(Baking *b, bool all)
{
    const Options *options = b->meshing->options;
    size_t         count = parts_triangle_count(b->parts), side = options->mesh_bake;
    float         *fineness = arena_new_array(options->arena, float, count);
    find_fineness(b->parts, all, fineness);
    if (!atlas_make(options->arena, b->parts, fineness, options->mesh_bake, &b->atlas))
        return say_usage(
            options,
            "%u pixels of --bake are too few for a mesh of so many faces that lie apart; "
            "more, or a larger --error",
            options->mesh_bake);
    if (!b->texels)
        b->texels = arena_new_array(options->arena, Texel, side * side);
    atomic_store(&b->next, 0);
    run_in_parallel(bake_rows, b);
    if (!mesh_is_wanted(b->meshing))
        return KRS_INTERRUPTED;
    if (atomic_load(&b->failed))
        return say_status(KRS_OUT_OF_MEMORY, options->files.items[0]);
    return KRS_OK;
}

/* Fills pixels that are near to no triangle from their neighbours, so that coarser pictures are
   good as well. */
static void fill(Baking *b)
{
    const size_t side = b->atlas.side, count = side * side;
    uint32_t    *queue  = arena_new_array(b->meshing->options->arena, uint32_t, count);
    size_t       filled = 0;
    for (size_t i = 0; i < count; i++)
        if (b->atlas.owner[i] != ATLAS_NONE)
            queue[filled++] = (uint32_t)i;
    for (size_t n = 0; n < filled; n++) {
        const size_t at = queue[n], x = at % side, y = at / side;
        const size_t beside[4] = {x > 0 ? at - 1 : at, x + 1 < side ? at + 1 : at,
                                  y > 0 ? at - side : at, y + 1 < side ? at + side : at};
        for (int k = 0; k < 4; k++) {
            if (b->atlas.owner[beside[k]] != ATLAS_NONE)
                continue;
            b->atlas.owner[beside[k]] = b->atlas.owner[at];
            b->texels[beside[k]]      = b->texels[at];
            queue[filled++]           = (uint32_t)beside[k];
        }
    }
}

/* ---- pictures ---- */

/* Finds the brightest emission, of which pictures have fractions. */
static void find_brightest(Baking *b)
{
    for (size_t i = 0; i < b->rows.count; i++)
        for (int k = 0; k < 3 && b->materials[i].baked[PICTURE_GLOW]; k++)
            b->materials[i].look.emission[k] = brightest_of(&b->rows.items[i].spread);
}

static void pixel_of(const Baking *b, int picture, size_t i, unsigned char rgb[3])
{
    const Texel        *texel     = &b->texels[i];
    const Piece        *row       = &b->rows.items[b->row_of[b->atlas.owner[i]]];
    const double        brightest = brightest_of(&row->spread);
    const unsigned char gloss[3]  = {0, texel->roughness, texel->metallic}; /* as glTF has them */
    memcpy(rgb, picture == PICTURE_COLOR ? texel->color : gloss, 3);
    for (int k = 0; k < 3 && picture == PICTURE_GLOW; k++)
        rgb[k] = brightest > 0 ? color_byte(texel->emission[k] / brightest) : 0;
}

static bool write_picture(const Baking *b, int number, MeshPicture *picture)
{
    const uint32_t side   = b->atlas.side;
    const size_t   count  = (size_t)side * side;
    unsigned char *pixels = malloc(3 * count);
    char          *bytes  = NULL;
    FILE          *out    = open_memstream(&bytes, &picture->length);
    png_image      image  = {
              .version = PNG_IMAGE_VERSION, .width = side, .height = side, .format = PNG_FORMAT_RGB};
    for (size_t i = 0; pixels && i < count; i++)
        pixel_of(b, number, i, pixels + 3 * i);
    bool written = pixels && out && png_image_write_to_stdio(&image, out, 0, pixels, 0, NULL);
    if (out && fclose(out) != 0)
        written = false;
    if (written)
        picture->bytes = arena_copy_text(b->meshing->options->arena, bytes, picture->length);
    free(bytes);
    free(pixels);
    return written;
}

static KrsStatus write_pictures(Baking *b)
{
    MeshPicture *pictures = arena_new_array(b->meshing->options->arena, MeshPicture, PICTURES);
    memset(pictures, 0, PICTURES * sizeof *pictures);
    for (int k = 0; k < PICTURES; k++) {
        bool wanted = false;
        for (size_t i = 0; i < b->parts->material_count; i++)
            wanted = wanted || b->parts->materials[i].baked[k];
        if (wanted && !write_picture(b, k, &pictures[k]))
            return say_status(KRS_OUT_OF_MEMORY, b->meshing->options->files.items[0]);
    }
    b->parts->pictures = pictures;
    return KRS_OK;
}

/* Keeps the places in the picture, in which v goes upwards, from 0 to 1. */
static void keep_places(Baking *b)
{
    size_t count          = parts_triangle_count(b->parts);
    double(*places)[3][2] = arena_alloc(b->meshing->options->arena, count, sizeof *places);
    const double side     = b->atlas.side;
    for (size_t t = 0; t < count; t++)
        for (int k = 0; k < 3; k++) {
            bool baked      = mesh_is_baked(&b->parts->materials[b->row_of[t]]);
            places[t][k][0] = baked ? b->atlas.corners[t][k][0] / side : 0;
            places[t][k][1] = baked ? 1 - b->atlas.corners[t][k][1] / side : 0;
        }
    b->parts->corner_places = (const double(*)[3][2])places;
}

static bool any_baked(const Baking *b)
{
    for (size_t i = 0; i < b->parts->material_count; i++)
        if (mesh_is_baked(&b->parts->materials[i]))
            return true;
    return false;
}

/* Returns how many of the pixels of triangles show materials that vary. */
static double share_baked(const Baking *b)
{
    size_t all = 0, baked = 0;
    for (size_t i = 0; i < b->rows.count; i++) {
        all += b->rows.items[i].spread.count;
        baked += mesh_is_baked(&b->materials[i]) ? b->rows.items[i].spread.count : 0;
    }
    return (double)baked / (double)all;
}

static KrsStatus bake_all(Baking *b)
{
    find_pieces(b);
    KrsStatus status = bake(b, true);
    if (status != KRS_OK)
        return status;
    find_spreads(b, &b->pieces, b->piece_of);
    find_rows(b);
    make_materials(b);
    if (any_baked(b) && share_baked(b) < MAX_BAKED_TWICE) {
        status = bake(b, false);
        find_spreads(b, &b->rows, b->row_of);
    }
    if (status != KRS_OK || !any_baked(b))
        return status;
    find_brightest(b);
    fill(b);
    keep_places(b);
    return write_pictures(b);
}

KrsStatus bake_materials(Meshing *meshing, MeshParts *parts, double error)
{
    const Options *options = meshing->options;
    Baking         b       = {.meshing = meshing, .parts = parts, .error = error};
    KrsStatus      status  = KRS_OK;
    parts->corner_colors   = NULL;
    for (size_t i = 0; i < parallel_parts() && status == KRS_OK; i++) {
        status = scene_state(options, meshing->scene, &b.states[i]);
        if (status == KRS_OK && options->animated)
            status = scene_set_time(options, b.states[i],
                                    options->time + options->first_frame / options->fps);
    }
    if (status == KRS_OK)
        status = bake_all(&b);
    for (size_t i = 0; i < MAX_PARTS; i++)
        krs_state_free(b.states[i]);
    if (status == KRS_OK)
        meshing->pixel = parts->pictures ? b.atlas.pixel : 0;
    return status;
}
