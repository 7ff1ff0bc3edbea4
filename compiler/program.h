/*
 * program.h: a compiled scene, as compile.c makes it and query.c asks it.
 */
#ifndef KRS_PROGRAM_H
#define KRS_PROGRAM_H

#include "compiler/compile.h"
#include "compiler/geometry/lower.h"
#include "compiler/graph/evaluate.h"

/* Roots of the graph, in this order: ROOT_COUNT for each component, then what a view needs. */
enum { CAMERA_ROOTS = 5, LIGHT_ROOTS = 3, SKY_ROOTS = 3 };

struct KrsScene {
    Memory       memory;
    Arena        arena; /* all that stays: graph, names, program */
    KrsProgram   program;
    const Graph *graph;
    const Node  *roots;
    size_t       component_count, camera_count, light_count;
    KrsComponent *components;
    Parameter   *parameters;
    size_t       parameter_count;
    SceneCamera *cameras; /* their nodes are not used: the roots are */
    SceneLight  *lights;
    bool         framed; /* the first camera stands in, and framing.c has placed it here: */
    double       framed_eye[3], framed_target[3];
    SceneImage   image;
    char         hash[17];
    Tape         distance; /* of all components */
    Tape         surface;  /* all roots of all components */
    Tape         view;     /* cameras, lights and sky */
};

static inline const Node *camera_roots(const KrsScene *scene, size_t camera)
{
    return scene->roots + scene->component_count * ROOT_COUNT + camera * CAMERA_ROOTS;
}

static inline const Node *light_roots(const KrsScene *scene, size_t light)
{
    return camera_roots(scene, scene->camera_count) + light * LIGHT_ROOTS;
}

static inline const Node *sky_roots(const KrsScene *scene)
{
    return light_roots(scene, scene->light_count);
}

#endif
