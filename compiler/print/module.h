/*
 * module.h: what the compiler makes of a scene, from which text is printed on request.
 */
#ifndef KRS_MODULE_H
#define KRS_MODULE_H

#include "compiler/lower/lower.h"
#include "compiler/print/state_values.h"
#include "compiler/print/printer.h"
#include "compiler/print/variant.h"

/* The slots of what the host finds: for each state, and for each origin of camera-relative points. */
typedef struct StateSlots {
    StateValues plain, camera_relative;
} StateSlots;

/* Boxes as numbers of the frame (OP_PARAMETERISED), two nodes each; NULL where they are literals. */
typedef struct BoxNodes {
    Node *around; /* of each component: centre, and half the lengths of the sides */
    Node *parts;  /* of each scene part: the low and the high corner */
} BoxNodes;

/* The nodes of a mirror (OP_fold) where normals are numbers of the frame: whether it may be in a
   row, and twice the products of its normal with those of the two mirrors before; NODE_NONE: there
   are none. */
typedef struct MirrorNodes {
    bool in_row;
    Node products[2];
} MirrorNodes;

typedef struct Module {
    const Graph *graph;   /* simplified; parameters have the first slots */
    Sources      sources; /* names and lines, for comments */
    /* Roots of functions, nodes of the graph.  Of each component: */
    size_t      components;
    const Node *surfaces; /* ROOT_COUNT, the distance among them */
    const Node *guarded;  /* lower_guarded */
    const Node *along;    /* lower_along */
    const Node *research; /* lower_research, method by method; or none */
    size_t      research_count;
    const Node
        *gradients; /* lower_gradient's two, of the zones as well; FLOATs where there is none */
    /* The rest is the scene's: */
    Node        zone;    /* the depth in zones, or NODE_NONE */
    const Node *volumes; /* of each medium, in the order of functions of KRS_FUNCTION_DENSITY */
    size_t      volume_count;
    const Node *planes; /* where a ray meets one, and how steeply it falls */
    const Node
        *camera_relative; /* surfaces, planes and the zone, if there is one, of camera-relative
                            points; NULL: there are none */
    /* The properties of components: */
    const Box      *boxes;
    BoxNodes        box_nodes;
    MirrorNodes    *mirror_nodes; /* by the mirror's node; NULL: where normals are literals */
    const uint32_t *march_groups; /* the group of each, or NULL: all together */
    const bool     *is_plane;  /* whether each is a plane that krs_plane_t knows; NULL: none is */
    const bool     *is_medium; /* whether each may let light through; NULL: none may */
    const bool     *is_subsurface; /* whether light may go on below its surface; NULL: none */
    bool            has_slopes;    /* there are slots of slopes behind those of parameters */
    bool            derives;       /* gradients were asked for */
    StateSlots      slots;
} Module;

/* Gives all that functions of the point need of the frame their slots, behind those of the
   parameters; `zone_slots` stay free before those of camera-relative points. */
void module_lay_out(Module *module, uint32_t zone_slots, Arena *arena, Arena *scratch);

/* Tells in how many parts so many components are marched, where each ray goes on with the one that
   comes next. */
uint32_t module_scene_part_count(size_t components);
/* Returns the first component of a part, or of the one behind the last. */
uint32_t module_scene_part_first(size_t part, size_t components);
/* Returns the box around a part. */
Box module_scene_part_box(const Box *boxes, size_t components, size_t part);
/* These find a finite box as shaders look at it from outside, and one that clips rays. */
void module_box_vectors(Box box, double centre[3], double half[3]);
void module_part_corners(Box box, double low[3], double high[3]);
/* Makes all boxes numbers of the frame, counted from `first` on. */
BoxNodes module_parameterise_boxes(Graph *graph, const Box *boxes, size_t components,
                                   uint32_t first, Arena *arena);

/* Adds what rows of mirrors need of the frame. */
MirrorNodes *module_parameterise_mirrors(Graph *graph, Arena *arena);

/* Returns the name of a function; NULL: it is several, or none. */
const char *module_function_name(KrsFunction function);

/* Adds the text of a variant: the wanted functions, and what they call.  Memory is that of `out`.
   A group has krs_distance and krs_along alone; a camera-relative one the distance, planes, scene parts
   and the surface. */
void module_print(const Module *module, const KrsVariant *variant, const KrsFunction *wanted,
                  size_t count, const Printer *printer, Text *out);

#endif
