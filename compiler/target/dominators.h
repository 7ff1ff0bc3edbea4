/*
 * dominators.h: which instructions of a flat function always run before which others.
 */
#ifndef KRS_DOMINATORS_H
#define KRS_DOMINATORS_H

#include "compiler/target/instructions.h"

typedef struct Dominators {
    uint32_t *block;         /* of each instruction of the body: the block around it */
    uint32_t *first, *count; /* of each block: the blocks that it dominates are a range of a
                                preorder of the tree; none for a block that is never reached */
} Dominators;

Dominators dominators_find(const ShaderModule *module);
/* Tells whether each way to instruction `later` passes instruction `earlier`. */
bool dominators_order(const Dominators *dominators, size_t earlier, size_t later);

#endif
