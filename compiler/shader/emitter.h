/*
 * emitter.h: what the files of the emitter share.
 *
 * statements.c and mirrors.c turn nodes into statements; emit.c, early_outs.c and march.c write the
 * functions around them.
 */
#ifndef KRS_EMITTER_H
#define KRS_EMITTER_H

#include "compiler/graph/regions.h"
#include "compiler/shader/emit.h"

typedef struct Emitter {
    const Graph   *graph;
    const Sources *sources;
    Arena         *scratch;
    Text          *out;
    const char   **text;    /* of a node in the function being written: its name or expression */
    uint8_t       *nesting; /* of that expression */
    uint32_t      *uses;    /* in the function being written */
    struct {
        Node  *items;
        size_t count, capacity;
    } needed;                  /* all that have uses, in order */
    const char **frame;        /* names of the globals that krs_prepare sets */
    uint8_t     *feeds_mirror; /* whether a mirror (OP_fold) uses it */
    const char **excess;       /* of mirrors in a row: the name of the point's excess over it */
    uint32_t     next;         /* number of the next local name */
    uint32_t     globals;
    uint32_t    *found_index; /* of values that the host finds: their index + 1 */
    bool         from_host;   /* there is nothing but what the host finds of the frame */
    Regions      regions;     /* of the function being written, where it has guards */
    Span         last;        /* the line that was commented last */
} Emitter;

/* ---- statements.c ---- */

/* Statements for all that the roots need, in a function of the point; e->text has what stands for
   each root then. */
void emit_body(Emitter *e, const Node *roots, size_t count);
/* Gives all that functions of the point need of the frame their places. */
void emit_lay_out(Emitter *e, const Node *roots, size_t count, FrameValues *values);
/* krs_prepare, and the globals that it sets: those values. */
void emit_frame(Emitter *e, const Node *roots, size_t count, const FrameValues *values);
/* The functions that operations call. */
void emit_helpers(Emitter *e, const Node *roots, size_t count);
/* A function that is not a list of statements: what it needs, with names for what is constant in
   it; then emit_node for each of the others. */
void emit_begin(Emitter *e, const Node *roots, size_t count);
void emit_node(Emitter *e, Node n);
/* Says where the next statement comes from, unless it is the same line as before. */
void emit_comment(Emitter *e, Span span);
/* A number, or a vector, as a literal. */
const char *emit_number(Emitter *e, double number);
const char *emit_vector(Emitter *e, const double v[3]);
/* An expression that is a whole statement needs no parentheses around it. */
const char *emit_bare(Emitter *e, const char *text);

/* ---- mirrors.c ---- */

/* The expression of a mirror (OP_fold), and statements before it; NULL: as the operation's row
   has it. */
const char *mirror_text(Emitter *e, const Expr *fold);
/* Whether that may name the point more than once. */
bool mirror_repeats(const Emitter *e, const Expr *fold);

/* ---- early_outs.c: krs_distance_lod ---- */

void emit_early_outs(Emitter *e, const EmitMarch *march, const Node *roots, size_t components);

/* ---- march.c: what some marches need beside a distance ---- */

/* krs_plane_t and krs_plane_cosine: where rays meet planes. */
void emit_planes(Emitter *e, const EmitMarch *march);
/* krs_scene_part_distance and krs_scene_part_box.  `boxes` of components; NULL: not known. */
void emit_scene_parts(Emitter *e, const Box *boxes, const bool *is_plane, size_t components);
/* krs_along by all methods that are better than the distance, and krs_probe. */
void emit_along(Emitter *e, const EmitMarch *march, const Node *roots, size_t components);

#endif
