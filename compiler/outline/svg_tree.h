/*
 * svg_tree.h: a drawing's XML as a tree of elements, and the styles that its rules give them.
 */
#ifndef KRS_SVG_TREE_H
#define KRS_SVG_TREE_H

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>

#include "compiler/base/text.h"

typedef struct SvgElement {
    const char        *name;       /* without the prefix `svg:` */
    const char *const *attributes; /* names and values by turns; NULL at the end */
    Text               text;       /* of `style`: what stands between its tags */
    unsigned           line;
    struct SvgElement *parent, *first, *last, *next; /* children in their order */
} SvgElement;

/* Tells whether nothing is seen of a character. */
static inline bool svg_is_blank(char c) { return isspace((unsigned char)c) != 0; }

/* A declaration of a rule, for what its selector matches. */
typedef struct SvgRule {
    const char *selector, *property, *value;
    unsigned weight; /* of two that match, the one of more weight counts, or else the later one */
} SvgRule;

typedef struct SvgTree {
    Arena      *arena;
    SvgElement *root;
    struct {
        SvgRule *items;
        size_t   count, capacity;
    } rules;
    const char *fault; /* why it cannot be read */
    unsigned    fault_line;
    unsigned    unknown_rules; /* the first line with one that means nothing here; 0: none */
} SvgTree;

/* Reads a tree, whose `arena` is set; false: it cannot be read. */
bool svg_tree_read(SvgTree *tree, const char *bytes, size_t length);
/* Adds the rules of a `style` element. */
void svg_rules_read(SvgTree *tree, const SvgElement *style);

/* Returns an attribute; NULL: there is none. */
const char *svg_attribute(const SvgElement *element, const char *name);
/* Returns a property by `style`, rules, or as an attribute, in the order of CSS. */
const char *svg_property(const SvgTree *tree, const SvgElement *element, const char *name);
/* Returns the element that `#id` or `url(#id)` names, or NULL. */
const SvgElement *svg_referred(const SvgTree *tree, const char *reference);

#endif
