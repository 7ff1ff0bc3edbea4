/*
 * flat.c: boxes that are halved until each has few planes.
 *
 * Where no surface is comes from ranges, and where one is, from its planes.  In the end each triangle is looked at
 * once: the surface must be in its middle.  Solids with round parts are given up where some of these are met: halving does not
 * end there.
 */
#include "compiler/mesh/flat.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { MOST_BOXES = 200000, MOST_HALVINGS = 45, HALVINGS_OF_REGION = 3, PATIENCE = 256 };
/* Boxes that were looked at when more than a part of them must have been flat. */
enum { FIRST_BOXES = 600 };
static const double LEAST_KNOWN = 0.02;

typedef struct Halving {
    Mesher    *m;
    MeshField *field;
    FlatFaces  faces;
    FlatPieces pieces;
    size_t     boxes, known;
} Halving;

static bool halve(Halving *h, Box box, int halvings);

static bool halve_at(Halving *h, Box box, int halvings)
{
    static const double MIDDLE = 0.4873; /* planes of scenes are seldom there */
    int                 axis   = box_longest_axis(&box);
    Range              *along  = &box.axis[axis];
    double              low = along->low, high = along->high, middle = low + MIDDLE * (high - low);
    along->high = middle;
    if (!halve(h, box, halvings + 1))
        return false;
    along->low  = middle;
    along->high = high;
    return halve(h, box, halvings + 1);
}

static bool is_wanted(Mesher *m)
{
    if (m->options->go_on && !m->options->go_on(m->options->user, 0))
        atomic_store(&m->stopped, true);
    return !atomic_load(&m->stopped);
}

static bool is_given_up(Halving *h, int halvings)
{
    h->boxes++;
    return (h->boxes % PATIENCE == 0 && !is_wanted(h->m)) || halvings > MOST_HALVINGS ||
           h->boxes > MOST_BOXES ||
           (h->boxes > FIRST_BOXES && (double)h->known < LEAST_KNOWN * (double)h->boxes);
}

static bool halve(Halving *h, Box box, int halvings)
{
    Range range = field_range(h->field, box);
    if (range.low > 0 || range.high < 0)
        return true;
    bool entered = halvings % HALVINGS_OF_REGION == 0 &&
                   halvings < MOST_REGIONS * HALVINGS_OF_REGION;
    bool done;
    if (entered)
        field_focus(h->field, box);
    if (flat_pieces(h->field, box, h->m->side, &h->m->arena, &h->pieces)) {
        h->known++;
        h->boxes++;
        done = flat_faces_add(&h->faces, box, &h->pieces);
    } else
        done = !is_given_up(h, halvings) && halve_at(h, box, halvings);
    if (entered)
        field_leave(h->field);
    return done;
}

/* Whether the surface is in the middle of each triangle: so all that was taken for a face is one. */
static bool is_on_surface(Mesher *m, const FlatVertices *vertices, const Triangles *triangles)
{
    static const double NEAR = 1e-6;
    for (size_t i = 0; i < triangles->count; i++) {
        double middle[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            add_scaled3(middle, middle, 1.0 / 3, vertices->items[triangles->items[i][k]]);
        if (!(fabs(field_distance(&m->fields[0], middle)) <= NEAR * m->side))
            return false;
    }
    return true;
}

bool find_flat_mesh(Mesher *m, FlatVertices *vertices, Triangles *triangles)
{
    Halving *h = arena_new(&m->arena, Halving);
    Box      box;
    *h = (Halving){.m = m, .field = &m->fields[0], .faces = {.arena = &m->arena, .size = m->side}};
    for (int k = 0; k < 3; k++) {
        double middle = 0.5 * (m->low[k] + m->high[k]);
        double half = 0.5 * (m->high[k] - m->low[k]) + m->error + 0.013 * m->side * (1 + 0.17 * k);
        box.axis[k] = (Range){middle - half, middle + half};
    }
    h->field->ranges.unroll = true;
    bool done               = is_wanted(m) && halve(h, box, 0);
    h->field->ranges.unroll = false;
    return done && flat_faces_finish(&h->faces, vertices, triangles) &&
           is_on_surface(m, vertices, triangles);
}
