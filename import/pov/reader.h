/*
 * reader.h: what those who read POV-Ray's language share.
 *
 * POV-Ray's space is left-handed: its z points away from the eye, that of
 * scenes towards it.  What is read is in POV-Ray's space.  It changes the sign
 * of z when it becomes a part, or is written: points by pov_point, maps by
 * transform_mirrored.
 */
#ifndef KRS_IMPORT_POV_READER_H
#define KRS_IMPORT_POV_READER_H

#include "import/common/part.h"
#include "import/common/words.h"

/* A number, a vector or a colour: red, green, blue, filter, transmit. */
typedef struct PovValue {
    double v[5];
    int    count; /* 1: a number, which may stand for a vector of equal ones */
} PovValue;

/* The ways in which light comes back: `exponent` of highlights is that of the cosine between the
   normal and the middle of both directions. */
typedef struct PovFinish {
    bool   specular, phong, mirrors_metal;
    double exponent, metallic, diffuse, ambient[3], emission[3];
    double reflection[3]; /* what is mirrored; where `mirrors_metal`, times the colour */
} PovFinish;

/* `said`: it is more than what is usual; `filter` and `transmit` are how much
 * light goes through. */
typedef struct PovLook {
    bool      said, colored, finished, patterned, textured;
    bool      averages; /* its pigment is the mean of a map's, by weights */
    int       pattern;  /* that of its pigment: a row of patterns.def, from 1 */
    double    color[3], filter, transmit, ior;
    PovFinish finish;
} PovLook;

/* `focal_point` is as far from `said_location` as what is sharp, wherever the camera is moved to then.
   `angle` and `angle_up` are 0 unless they are said. */
typedef struct PovView {
    bool     has_camera, orthographic, spherical, widened, has_direction, mirrored;
    double   location[3], look_at[3], sky[3], direction[3], right[3], up[3], angle, angle_up;
    double   said_location[3], focal_point[3], aperture, blur_samples;
    bool     looks, has_focal_point;
    double   horizon; /* how far the farthest plane is from the eye; 0: there is none */
    unsigned line, spherical_line;
} PovView;

typedef struct PovLight {
    double   position[3], target[3], color[5], full, falloff;
    bool     parallel, shadowless, spot;
    unsigned line;
} PovLight;

typedef enum PovKind {
    POV_NOTHING,
    POV_VALUE,
    POV_STRING,
    POV_OBJECT,
    POV_LOOK,
    POV_SKY, /* the look of a `sky_sphere` */
    POV_CAMERA,
    POV_LIGHT,
    POV_PLACE,
    POV_ARRAY,
    POV_MACRO,
    POV_FUNCTION,
    POV_OTHER,  /* what changes no shape: it is known, and left out */
    POV_REFUSED /* of an included file; `string` says why, to who uses it */
} PovKind;

/* The text of a macro or of a function. */
typedef struct PovMacro {
    struct {
        const char **items;
        size_t       count, capacity;
    } parameters;
    const char *at;
    unsigned    line, fixed_line;
} PovMacro;

enum { POV_MAX_DIMENSIONS = 5 };

typedef struct PovCell {
    PovKind          kind;
    PovValue         value;
    const char      *string;
    Part            *part;
    PovLook          look;
    Transform        transform;
    const PovView   *view;
    const PovLight  *light;
    const PovMacro  *macro;
    struct PovCell **items; /* of an array */
    int              sizes[POV_MAX_DIMENSIONS], dimensions;
} PovCell;

typedef struct PovName {
    const char *name;
    PovCell    *cell;
} PovName;

/* A source of words: the file, one that it includes, or a macro. */
typedef struct PovSource {
    const char *at; /* where it goes on, while another one is read */
    unsigned    line;
    unsigned    fixed_line; /* all words count as of this line, where that is not 0 */
    bool        macro;
    size_t      names_before; /* behind them are those of its own */
} PovSource;

typedef struct PovBlock {
    enum { POV_IF, POV_WHILE, POV_FOR, POV_SWITCH, POV_MACRO_BODY } kind;
    size_t      source;
    unsigned    line;
    const char *at; /* of a loop: where it goes on */
    unsigned    at_line;
    PovCell    *cell; /* of `#for` */
    double      last, step;
} PovBlock;

typedef struct PovReader {
    WordReader words;
    Import    *import;
    int        depth;
    int        open, held_at; /* brackets; where directives wait, or -1 */
    size_t     words_read;
    struct {
        PovSource *items;
        size_t     count, capacity;
    } sources;
    struct {
        PovBlock *items;
        size_t    count, capacity;
    } blocks;
    struct {
        PovName *items;
        size_t   count, capacity;
    } names;
    struct {
        const char **items;
        size_t       count, capacity;
    } shared; /* names of objects, as often as they were declared */
    struct {
        PovLight *items;
        size_t    count, capacity;
    } lights;
    Part *shown;     /* a union of what the scene has */
    Text  materials; /* of looks that are more than a colour */
    struct {
        const char **items; /* what stands in their braces */
        size_t       count, capacity;
    } material_texts;
    size_t   flat_figures; /* triangles and polygons so far */
    PovLook  usual;        /* of `#default` */
    PovView  view;
    double   version;     /* of `#version` in the file itself; 0: none */
    double   gamma;       /* exponent of colours; 0: the curve of sRGB */
    double   found_gamma; /* the same, of `assumed_gamma`; below 0: there is none */
    double   ambient[3];  /* of `ambient_light` */
    bool     has_background;
    double   background[3];
    unsigned background_line;
} PovReader;

/* ---- programs: sdl.c ---- */

void pov_start(PovReader *reader);
/* The last one of a name counts; NULL: there is none. */
PovCell *pov_find(PovReader *reader, const char *name);
/* Finds what the next word names. */
PovCell *pov_find_next(PovReader *reader);
/* Carries out a directive or macro that waits at the word. */
bool pov_release(PovReader *reader);
/* Reads `default { ... }`, up to its `}`. */
bool pov_default(PovReader *reader);
/* The state of reading, to go back to after a refusal. */
typedef struct PovState {
    ImportWord  word;
    const char *at;
    unsigned    line;
    int         depth, open, held_at;
    size_t      sources, blocks;
    PovSource   top;
} PovState;
void pov_keep_state(PovReader *reader, PovState *state);
void pov_restore_state(PovReader *reader, const PovState *state);
/* Returns the cell that a declaration fills; NULL after a refusal. */
PovCell *pov_cell_to_fill(PovReader *reader, const char *name, bool local);
/* Goes on behind what called the macro, or included the file, that is read. */
void pov_pop_source(PovReader *reader);
/* Evaluates a function for these numbers. */
bool pov_evaluate(PovReader *reader, const PovMacro *function, const double *numbers,
                  PovValue *value);

/* ---- conditions and loops: blocks.c ---- */

/* Reads `#if`, `#while`, `#end` and others, whose name is the word; *taken: it was one of them. */
bool pov_block_directive(PovReader *reader, const char *name, bool *taken);
/* Returns the innermost block; NULL: there is none. */
PovBlock *pov_top_block(PovReader *reader);
void      pov_push_block(PovReader *reader, PovBlock block);
/* Skips to the end of so many blocks. */
bool pov_leave(PovReader *reader, int depth);

/* ---- what may be declared: declared.c ---- */

/* Reads whatever may stand behind `#declare NAME =`. */
bool pov_rvalue(PovReader *reader, PovCell *cell);
/* Reads a parameter of a macro: a name stands for what is named. */
bool pov_argument(PovReader *reader, PovCell **cell);
/* Reads the indices behind the name of an array; NULL after a refusal. */
PovCell *pov_element(PovReader *reader, PovCell *array);
/* Takes a name, with its indices, that is declared for this kind; NULL: the
 * word is none. */
PovCell *pov_take(PovReader *reader, PovKind kind);

/* ---- values: values.c ---- */

/* Tells whether the next word begins a number or a vector. */
bool pov_value_follows(PovReader *reader);
bool pov_value(PovReader *reader, PovValue *value);
/* Does the same between parentheses, where values may be compared. */
bool pov_condition(PovReader *reader, PovValue *value);
/* Returns an element of an array that was filled. */
const PovCell *pov_first_element(const PovCell *array);
/* Reads the next argument of a function. */
bool pov_next_argument(PovReader *reader, PovValue *value);
bool pov_string_follows(PovReader *reader);
bool pov_string(PovReader *reader, const char **string);
bool pov_number(PovReader *reader, double *number);
bool pov_vector(PovReader *reader, double v[3]);
/* Makes a number a vector of `count` equal ones; what a vector lacks becomes 0. */
void pov_promote(PovValue *value, int count);

/* ---- colours: colors.c ---- */

/* Tells whether `color rgb <1, 0, 0>`, a vector, or a name follows. */
bool pov_color_follows(PovReader *reader);
/* Reads red, green, blue, filter, transmit. */
bool pov_color(PovReader *reader, double color[5]);
/* Returns the light of a channel of a colour.  Colours of files are in the space of
   `assumed_gamma`; without it, those of old ones are as they are shown. */
double pov_light_of(const PovReader *reader, double channel);

/* ---- words: words.c ---- */

bool pov_deeper(PovReader *reader);
/* Skips from `{` to the `}` that belongs to it. */
bool pov_skip_block(PovReader *reader);
/* Leaves out a word with a note (`what` NULL: without one), and the values or the block behind
 * it. */
bool pov_leave_out(PovReader *reader, const char *what);
/* Adds `translate`, `rotate`, `scale` or `matrix` to a transform in POV-Ray's space; *taken: it was
   one of them. */
bool pov_transform(PovReader *reader, Transform *transform, bool *taken);
/* Finds where a point is in the space of scenes. */
void pov_point(const double q[3], double p[3]);

/* ---- looks: looks.c ---- */

/* Reads `pigment`, `finish`, `texture` and `material` with their blocks; *taken likewise. */
bool pov_look(PovReader *reader, PovLook *look, bool *taken);
/* Returns the look of what says nothing, and nothing of `#default` yet. */
PovLook pov_usual_look(void);
/* Adds a layer of a sky on those before it, which show as far as light goes through. */
void pov_add_layer(PovLook *below, const PovLook *layer);
/* Reads what stands in such a block, or where one may be left away. */
bool pov_look_inside(PovReader *reader, PovLook *look);
/* Returns the argument of `.paint`; NULL: the look says nothing. */
const char *pov_look_text(PovReader *reader, const PovLook *look);

/* ---- files: include.c ---- */

/* Reads the text of an included file, in the import's arena; NULL: there is none, which is noted.
   Returns false after a refusal. */
bool pov_read_included(Import *import, unsigned line, const char *name, const char **text);

/* ---- objects: objects.c and shapes.c ---- */

bool pov_object_follows(const PovReader *reader);
bool pov_object(PovReader *reader, Part **part);

/* Reads what stands in the block of a shape before its modifiers. */
typedef bool PovBuild(PovReader *reader, unsigned line, Part **part);
PovBuild     pov_prism, pov_lathe, pov_text, pov_disc, pov_blob, pov_superellipsoid, pov_julia;
PovBuild     pov_polygon, pov_triangle, pov_smooth_triangle;
/* Tells whether what is next changes an object as a whole, or ends it. */
bool     pov_modifier_follows(const PovReader *reader);
PovBuild pov_sphere, pov_box, pov_cylinder, pov_cone, pov_torus, pov_plane, pov_quadric, pov_cubic,
    pov_quartic, pov_poly;

/* Returns a figure in x and y of contours that end where they begin, and cut holes into each other;
   NULL: of no area. */
Part *pov_figure(PovReader *reader, unsigned line, double (*points)[3], size_t count);

/* ---- surfaces that enclose nothing: open_surfaces.c ---- */

bool pov_is_open_surface(const Part *part);
/* Cuts the surface of an object that has been placed so far in POV-Ray's space; the region is where
   scenes have it. */
bool pov_clip(PovReader *reader, const Transform *transform, Part **part, unsigned line,
              Part *region);
/* Leaves the side of a column. */
bool pov_open(PovReader *reader, unsigned line, Part **part);

/* ---- the view: view.c ---- */

bool pov_camera(PovReader *reader, PovView *view);
bool pov_light(PovReader *reader, PovLight *light);
bool pov_background(PovReader *reader);
/* Reads `sky_sphere { ... }`; nothing is coloured where it has no pigment. */
bool pov_sky_look(PovReader *reader, PovLook *sky);
/* The mean of its colours is the background. */
bool pov_sky_sphere(PovReader *reader);
/* Reads `global_settings`. */
bool pov_settings(PovReader *reader);
/* Ends the view when all was read: without a camera POV-Ray has one at the origin; shapes alone are
   seen as a whole here. */
void pov_finish_view(PovReader *reader);
void pov_write_view(PovReader *reader);

#endif
