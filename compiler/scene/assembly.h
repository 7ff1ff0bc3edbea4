/*
 * assembly.h: components as parts and where their copies are.
 *
 * A sequence whose mirrors cut nothing is its kernels, placed many times.  So each item is a part,
 * which has a distance, or it is made of items before it.  Items of 2^20 copies are a few dozen.
 */
#ifndef KRS_ASSEMBLY_H
#define KRS_ASSEMBLY_H

#include "compiler/graph/evaluate.h"
#include "krs/krs.h"
#include "compiler/shape/box.h"

#define NO_ITEM UINT32_MAX

/* The placing of an item: as it is, as its image in a mirror, which must not cut it, or by a map. */
typedef enum PlacingKind { PLACED_STILL, PLACED_MIRRORED, PLACED_MAPPED } PlacingKind;

typedef struct AssemblyTransform {
    uint32_t    item;
    PlacingKind kind;
    uint32_t    root; /* the first of its numbers: MirrorRoots or MapRoots */
} AssemblyTransform;

typedef struct MirrorRoots {
    Node normal, offset;
} MirrorRoots;
typedef struct MapRoots {
    Node scale, rows[3], shift;
} MapRoots;

typedef struct AssemblyItem {
    uint32_t    first, count; /* its transforms; 0: it is a part */
    uint32_t    root;         /* of a part: its distance */
    Box         box;          /* of a part */
    bool        estimate;     /* likewise: nothing is proven of its distance */
    const char *name;         /* likewise, by the author */
} AssemblyItem;

/* The beams of a component that is shown: the first of its numbers, each a SceneBeam. */
typedef struct AssemblyBeams {
    uint32_t root;
    size_t   count;
} AssemblyBeams;

typedef struct Assembly {
    struct {
        AssemblyItem *items;
        size_t        count, capacity;
    } items; /* each behind those that it is made of */
    struct {
        AssemblyTransform *items;
        size_t             count, capacity;
    } transforms;
    uint32_t      *of_component; /* the item of each component that is lowered; or NO_ITEM */
    KrsMotion     *motions;      /* of these; NULL: nobody asks */
    AssemblyBeams *beams;        /* of components that are shown; NULL: nobody asks */
    Tape           tape;
} Assembly;

#endif
