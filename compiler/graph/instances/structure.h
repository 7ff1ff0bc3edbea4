/*
 * structure.h: expressions of one structure, which differ in numbers only.
 *
 * A template is made of the expressions of one instance.  An instance is alike if its expressions have
 * the same operations on the same leaves.  Numbers that are known now, or in each frame, may differ
 * where what depends on the point uses them.  Each such use, an operand of an operation, is a slot.
 * Slots belong to uses and not to nodes, since equal numbers are one node by chance.  Truth values
 * and integers are the same in both.  Numbers that decide how long a loop runs are equal.
 */
#ifndef KRS_STRUCTURE_H
#define KRS_STRUCTURE_H

#include "compiler/graph/graph.h"

/* The structures of the nodes of a graph. */
typedef struct Structures Structures;

Structures *structures_new(Graph *graph, Arena *arena);
/* Forgets nodes from this one on, which were dropped (graph_release): others may take their
   places. */
void structures_forget(Structures *structures, size_t first);

/* The use of a node by an operand of a node of a template, or by one of its roots. */
typedef struct TemplateUse {
    enum {
        USE_SAME, /* the node `index` of the graph, a leaf or known in each frame; or NODE_NONE */
        USE_NODE, /* nodes[index] of the template */
        USE_SLOT, /* slots[index] */
        USE_KNOWN /* known[index]; of a template that is detached */
    } kind;
    uint32_t index;
} TemplateUse;

typedef struct TemplateNode {
    Node        node;
    uint8_t     op, type;
    uint32_t    index;
    TemplateUse uses[MAX_OPERANDS];
} TemplateNode;

/* A number, a count or a truth value that is the same in all instances. */
typedef struct TemplateKnown {
    GraphType type;
    NodeValue value;
} TemplateKnown;

typedef struct Template {
    uint64_t      hash;
    TemplateNode *nodes; /* what depends on the point, but leaves; operands first */
    uint32_t      node_count;
    Node      *slots; /* what the instance of the template has there: FLOAT or a vector, and where a
                            root is a number also UINT */
    GraphType *slot_types;
    uint32_t   slot_count;
    TemplateUse *roots;
    uint32_t     root_count;
    Node        *images; /* of each node, that of the instance; template_match's own */
    struct {
        TemplateKnown *items;
        size_t         count, capacity;
    } known;
} Template;

/* The content of a slot, by elements. */
typedef struct SlotContent {
    double numbers[4];
    Node   nodes[4]; /* FLOAT, where the number is one of the frame; NODE_NONE: it is known */
} SlotContent;

/* Hashes structures, so that equal ones have equal hashes.  Roots may be NODE_NONE. */
uint64_t  structure_hash(Structures *structures, const Node *roots, uint32_t count);
Template *template_new(Structures *structures, const Node *roots, uint32_t count, Arena *arena);
/* Makes a template independent of nodes from this one on, which may be dropped then: it serves
   template_match alone.  False: it cannot be. */
bool template_detach(Structures *structures, Template *template, size_t first, Arena *arena);
/* Tells whether as many roots are alike.  What is in their slots goes to `contents`, slot_count of them;
   for its elements nodes may be made. */
bool template_match(Structures *structures, const Template *template, const Node *roots,
                    SlotContent *contents);

/* Leaves that are replaced in a copy. */
typedef struct LeafPair {
    Node leaf, by;
} LeafPair;

/* Copies a template with nodes in the slots.  Of the roots those that are `wanted` are copied; the
   others become NODE_NONE. */
void template_copy(Graph *graph, const Template *template, const Node *slots, const LeafPair *pairs,
                   uint32_t pair_count, const bool *wanted, Node *roots, Arena *scratch);
/* Tells whether the wanted roots need this leaf. */
bool template_needs(const Template *template, Node leaf, const bool *wanted, Arena *scratch);
/* Marks the slots that the wanted roots need. */
void template_slots_of(const Template *template, const bool *wanted, bool *needed, Arena *scratch);

#endif
