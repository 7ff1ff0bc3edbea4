/*
 * emitter.h: what the files that print a module share.
 *
 * statements.c and mirrors.c turn nodes into statements; distances.c, surfaces.c, instances.c,
 * early_outs.c and march.c write the functions around them; module_print.c puts all together.  None of
 * them knows the language: what differs between languages is a template (templates.def), a type, an
 * operation or a helper of the printer.
 */
#ifndef KRS_EMITTER_H
#define KRS_EMITTER_H

#include "compiler/graph/regions.h"
#include "compiler/print/module.h"

/* Functions of one component.  They are printed in this order, before those of the scene. */
typedef enum FunctionKind {
    OF_DISTANCE,
    OF_ALONG,
    OF_PROBE,
    OF_LOD,
    OF_GRADIENT,
    OF_SURFACE,
    FUNCTION_KINDS
} FunctionKind;

/* A function and what it computes. */
typedef struct ModuleFunction {
    FunctionKind kind;
    uint32_t     component; /* from 0 */
    const Node  *roots;
    uint32_t     root_count;
} ModuleFunction;

/* A function of the helpers' files. */
typedef struct Helper {
    const char *name, *type; /* of the function, and of its first operand; not terminated */
    size_t      name_length, type_length;
    const char *text;
    size_t      length;
    bool        printed;
} Helper;

typedef struct NodeList {
    Node  *items;
    size_t count, capacity;
} NodeList;

/* A texel of a table's row that has been loaded. */
typedef struct RowTexel {
    uint32_t    table_number, texel;
    Node        instance;
    const char *name;
} RowTexel;

typedef struct Emitter {
    const Module     *module;
    const KrsVariant *variant;
    const Printer    *printer;
    const Graph      *graph;
    bool              cuts; /* zones are cut out of distances: there is krs_cut */
    Arena            *scratch;
    Text             *out;
    bool              wanted[KRS_FUNCTION_COUNT];
    bool             *needed_of[FUNCTION_KINDS]; /* of each component, whether it is called */
    const char *
        *operations;      /* of each operation and type, in words of the printer; NULL: not yet */
    const char **text;    /* of a node in the function being written: its name or expression */
    uint8_t     *nesting; /* of that expression */
    uint32_t    *uses;    /* in the function being written */
    NodeList     needed;  /* all that have uses, in order */
    const char **given;   /* names of nodes that the function need not compute */
    uint8_t     *mark;    /* for walks, zero between them */
    uint32_t    *rank;    /* how many noises a value needs, one in the other (noises.c) */
    uint32_t     iterations;     /* of loops over noises, so far */
    bool         gathers_noises; /* in the function being written */
    const char **frame;          /* names of the globals that krs_prepare sets */
    bool        *slot_is_read;   /* in krs_prepare: whether a local has the slot's numbers */
    uint8_t     *feeds_mirror;   /* whether a mirror (OP_fold) uses it */
    const char **excess; /* of mirrors in a row: the name of how far beyond it the point is */
    uint32_t     next;   /* number of the next local name */
    uint32_t     globals;
    uint32_t    *place;       /* of values that the host finds: their number + 1 */
    Regions      regions;     /* of the function being written, where it has guards */
    Span         last;        /* the line that was commented last */
    uint8_t     *called;      /* of each instance function: how many operands calls have behind its
                                  number; 0: there is no call.  NULL: there are no instance groups */
    bool        *reads_table; /* of each table */
    bool        *reads_texture; /* of each texture */
    bool         sees;          /* something needs the ray that sees the surface */
    struct {
        RowTexel *items;
        size_t    count, capacity;
    } row_texels; /* in the function being written, where its statements can see them */
    struct {
        Helper *items;
        size_t  count, capacity;
    } helpers;        /* of the printer */
    Text helper_text; /* of those that are called */
} Emitter;

/* Makes room for what is known of each node of a module. */
Emitter emitter_new(const Module *module, Arena *scratch);

/* ---- statements.c ---- */

/* Emits statements for all that the roots need, in a function of the point; e->text has what stands
   for each root then. */
void emit_body(Emitter *e, const Node *roots, size_t count);
/* Begins a function that is not a list of statements: what it needs, with names for what is
   constant in it; then emit_node for each of the others. */
void emit_begin(Emitter *e, const Node *roots, size_t count);
void emit_node(Emitter *e, Node n);
/* Does the same for a node of the point; a node that is given has its name. */
void emit_point_node(Emitter *e, Node n);
/* Emits the expression of a node whose operands have theirs. */
const char *emit_expression(Emitter *e, const Expr *expr);
/* Finds the nodes that a function needs, counting uses; unless it is one of the `frame`, frame
   values end the walk. */
void emit_count_uses(Emitter *e, const Node *roots, size_t count, bool frame);

/* ---- noises.c ---- */

/* Emits the statements of a body, in which many noises are one loop. */
void emit_with_noises(Emitter *e);

/* ---- lines.c ---- */

/* Emits a line of code, in which alternatives of the printer are written out. */
void emit_line(Emitter *e, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The operands of a template, as many as its row says. */
typedef const char *Operands[3];
/* These return the printer's words for a template; the second writes them as a line. */
const char *template_text(Emitter *e, TextTemplate template, const Operands operands);
void        emit_template(Emitter *e, TextTemplate template, const Operands operands);
/* These emit a local variable that stays as it is, and one that changes. */
void emit_local(Emitter *e, GraphType type, const char *name, const char *value);
void emit_variable(Emitter *e, GraphType type, const char *name, const char *value);
/* Says where the next statement comes from, unless it is the same line as before, or the same file
   of the standard library. */
void emit_comment(Emitter *e, Span span);
/* These emit a constant; a number, or a vector, as a literal. */
const char *emit_constant(Emitter *e, const Expr *constant);
const char *emit_number(Emitter *e, double number);
const char *emit_vector(Emitter *e, const double v[3]);
/* Emits a vector of a box: the global of node `index`, or a literal where there are no nodes. */
const char *emit_box_vector(Emitter *e, const Node *nodes, size_t index, const double v[3]);
/* Returns an expression without the parentheses around it, which a whole statement does not need. */
const char *emit_bare(Emitter *e, const char *text);
/* Returns a count, or the number of something. */
const char *emit_count(Emitter *e, size_t count);
/* Returns `width` components of a slot of the block. */
const char *emit_slot(Emitter *e, uint32_t slot, uint32_t first, uint32_t width);

/* ---- helpers.c ---- */

/* Reads the printer's files; then, of a call in a text, what it needs is in e->helper_text. */
void helpers_read(Emitter *e);
/* Notes that the function which `name` begins with is called, with so many operands of that type.  Returns
   the name of the function for that type. */
const char *emit_call(Emitter *e, const char *name, GraphType type, uint32_t operands);
/* Writes a function of these files that is one of a component: N in it stands for the number. */
void emit_helper_of(Emitter *e, const char *name, uint32_t component);

/* ---- signatures.c ---- */

/* Writes the prototype of an entry point, with a comment; nothing where it has no name of its own. */
void emit_entry_point(Emitter *e, KrsFunction function);
void emit_prepare_entry_point(Emitter *e);
/* Emits what a function begins with, up to its brace. */
void emit_head(Emitter *e, KrsFunction function);
void emit_prepare_head(Emitter *e);
void emit_zone_depth_head(Emitter *e);
/* The functions of a medium: those of KRS_FUNCTION_DENSITY and behind it. */
enum { VOLUME_FUNCTIONS = 4 };
void        emit_head_of_volume(Emitter *e, uint32_t which, uint32_t volume);
const char *emit_call_of_volume(Emitter *e, uint32_t which, uint32_t volume);
void        emit_head_of(Emitter *e, FunctionKind kind, uint32_t component);
/* These emit a call of a component's function, in one with operands of the same names, or with
   others. */
const char *emit_call_of(Emitter *e, FunctionKind kind, uint32_t component);
const char *emit_call_with(Emitter *e, FunctionKind kind, uint32_t component, const char *operands);

/* ---- prepare.c ---- */

/* Emits krs_prepare, and the globals that it sets: frame values that the roots read. */
void emit_prepare(Emitter *e, const Node *roots, size_t count, const StateValues *values);
/* Tells whether functions need the zones of the caller. */
bool emit_reads_zones(const Emitter *e);
/* Returns the slots that are in the block of a variant before zones of the caller. */
uint32_t emit_slot_count(const Emitter *e);

/* ---- mirrors.c ---- */

/* Returns the expression of a mirror (OP_fold), and statements before it; NULL: as the operation's
   row has it. */
const char *mirror_text(Emitter *e, const Expr *fold);
/* Tells whether that may name the point more than once. */
bool mirror_repeats(const Emitter *e, const Expr *fold);
/* Returns what a mirror needs of the frame besides its operands; NULL: nothing. */
const MirrorNodes *mirror_nodes(const Emitter *e, Node fold);

/* ---- Functions: what they need of each component, and their text ---- */

/* distances.c: krs_distance, what zones cut out, krs_gradient. */
/* Emits a distance without what zones cut out. */
const char *emit_cut(Emitter *e, const char *distance);
void        need_distance(Emitter *e);
void        need_gradient(Emitter *e);
void        need_tangent(Emitter *e);
/* Tells whether krs_tangent keeps the distance to a component's plane from overflow by the box around the component. */
bool emit_keeps_plane(const Emitter *e, uint32_t component);
/* Tells whether a function is wanted that finds the gradient of what is nearest. */
bool emit_wants_gradient(const Emitter *e);
/* Tells whether the gradient of a component is known by derivatives. */
bool emit_has_gradient(const Emitter *e, uint32_t component);
/* Tells whether krs_surface takes the plane of that gradient for the distance.  Outside of the box around the
   component the box counts: far away polynomials are beyond all numbers. */
bool emit_has_tangent(const Emitter *e, uint32_t component);
/* Emits the distance to the box around a component, which is finite; 0 inside. */
const char *emit_box_distance(Emitter *e, uint32_t component);
void        emit_distance_of(Emitter *e, const ModuleFunction *function);
void        emit_gradient_of(Emitter *e, const ModuleFunction *function);
void        emit_zones(Emitter *e);
/* Tells how deep points of the variant are in the zones of the scene; NODE_NONE: there are none. */
Node emit_zone(const Emitter *e);
void emit_distance(Emitter *e);
void emit_gradient(Emitter *e);
void emit_tangent(Emitter *e);

/* volumes.c: functions of media that scatter light. */
void emit_volumes(Emitter *e);
void emit_density(Emitter *e);
void emit_albedo(Emitter *e);
void emit_anisotropy(Emitter *e);
void emit_emission(Emitter *e);
/* Tells whether this function of media is wanted. */
bool emit_wants_volume(const Emitter *e, uint32_t which);

/* shared.c: what a component's distance and surface have in common. */
/* Finds the values that the distance hands over; false: each is computed by itself. */
bool emit_find_shared(Emitter *e, uint32_t component, NodeList *shared);
void emit_shared_distance(Emitter *e, const ModuleFunction *distance, const NodeList *shared);
/* Emits the statements of the rest of a surface. */
void emit_shared_rest(Emitter *e, const ModuleFunction *surface, const NodeList *shared);

/* surfaces.c: KrsSurface and krs_surface. */
void emit_struct(Emitter *e);
void need_surface(Emitter *e);
void emit_surface_of(Emitter *e, const ModuleFunction *function);
void emit_surface(Emitter *e);
/* Emits what is anywhere in a scene without components: `nearest`. */
void emit_nothing(Emitter *e);

/* instances.c: functions of instance groups, and the tables that they read. */
/* Finds what these functions call; bodies of that join their roots. */
void emit_find_called(Emitter *e, NodeList *roots);
bool emit_reads_tables(const Emitter *e);
/* Emits globals for headers of tables, and in krs_prepare their values. */
void emit_table_globals(Emitter *e);
void emit_table_reads(Emitter *e);
void emit_instances(Emitter *e);
/* These return expressions of OP_row, calls and OP_STATE. */
const char *emit_row(Emitter *e, const Expr *row);
const char *emit_instance_call(Emitter *e, const Expr *call);
const char *emit_state(Emitter *e, const Expr *state);

/* textures.c: textures, and the ray that sees a surface. */
/* Notes what a node needs of the text besides its operands. */
void emit_note_seen(Emitter *e, const Expr *expr);
bool emit_reads_textures(const Emitter *e);
/* Emits globals for textures and the ray, and in krs_prepare their values. */
void        emit_texture_globals(Emitter *e);
void        emit_texture_reads(Emitter *e);
const char *emit_texture(Emitter *e, const Expr *texture);

/* early_outs.c: krs_distance_lod. */
void need_lod(Emitter *e);
void need_lod_of(Emitter *e, uint32_t component);
void emit_lod_of(Emitter *e, const ModuleFunction *function);
void emit_lod(Emitter *e);

/* media.c: distances and surfaces of rays that are inside of glass, or are not. */
/* Tells whether a component is a medium of the variant. */
bool emit_is_medium(const Emitter *e, uint32_t component);
/* Tells whether rays of the variant are in media. */
bool emit_has_media(const Emitter *e);
/* Emits the globals of media. */
void emit_media_globals(Emitter *e);
/* Emits what is left of `variable`, the least length to solids that are no media, with those to the
   boundaries of media, which are functions of this kind; and cut by zones. */
void emit_media_steps(Emitter    *e, FunctionKind (*kind_of)(const Emitter *e, uint32_t component),
                      const char *variable);
/* Does the same, left in the variable. */
void emit_seen_steps(Emitter    *e, FunctionKind (*kind_of)(const Emitter *e, uint32_t component),
                     const char *variable);
/* Emits the gradient `other` of a component, as the ray sees it. */
void emit_media_gradient(Emitter *e, uint32_t component);
void emit_media_surface(Emitter *e);
void need_media(Emitter *e);
void emit_medium_at(Emitter *e);
void emit_glass(Emitter *e);
void need_subsurface(Emitter *e);
void emit_subsurface(Emitter *e);

/* march.c: what some marches need beside a distance: krs_plane_t and krs_plane_cosine;
   krs_scene_part_distance and krs_scene_part_box; krs_along, krs_steps and krs_probe. */
void emit_plane_t(Emitter *e);
void emit_plane_cosine(Emitter *e);
void need_scene_parts(Emitter *e);
void emit_scene_part_distance(Emitter *e);
void emit_scene_part_box(Emitter *e);
void need_along(Emitter *e);
void need_probe(Emitter *e);
void emit_along_of(Emitter *e, const ModuleFunction *function);
void emit_along(Emitter *e);
void emit_separate_steps(Emitter *e);
void emit_probe(Emitter *e);

/* ---- module_print.c ---- */

/* Returns the roots of a function of a component. */
ModuleFunction emit_function(const Emitter *e, FunctionKind kind, uint32_t component);
/* Returns krs_plane_t's root and krs_plane_cosine's. */
const Node *emit_planes(const Emitter *e);
/* Returns what a function computes first. */
Node emit_root(const Emitter *e, FunctionKind kind, uint32_t component);
/* Tells whether a component is of the variant's march group, which may be that of the planes. */
bool emit_is_of_group(const Emitter *e, uint32_t component);
/* Tells whether distances of the variant leave a component out that is a plane, or of another group. */
bool emit_leaves_out(const Emitter *e, uint32_t component);

#endif
