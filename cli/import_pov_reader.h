/*
 * import_pov_reader.h: what those who read POV-Ray's language share.
 *
 * POV-Ray's space is left-handed: its z points away from the eye, that of scenes towards it.  What
 * is read is in POV-Ray's space.  It changes the sign of z when it becomes a part, or is written:
 * points by pov_point, maps by place_mirrored.
 */
#ifndef KRS_IMPORT_POV_READER_H
#define KRS_IMPORT_POV_READER_H

#include "cli/import_part.h"
#include "cli/import_words.h"

/* A number, a vector or a colour: red, green, blue, filter, transmit. */
typedef struct PovValue {
    double v[5];
    int    count; /* 1: a number, which may stand for a vector of equal ones */
} PovValue;

typedef struct PovLook {
    bool   colored, finished, specular;
    double color[3], size, metallic; /* `size` of highlights, as in `phong_size` */
} PovLook;

typedef enum PovNameKind { POV_VALUE, POV_OBJECT, POV_LOOK } PovNameKind;

typedef struct PovName {
    const char *name;
    PovNameKind kind;
    PovValue    value;
    Part       *part;
    PovLook     look;
} PovName;

typedef struct PovView {
    bool     has_camera, orthographic, has_direction;
    double   location[3], look_at[3], sky[3], direction[3], right[3], up[3], angle;
    bool     looks;
    unsigned line;
} PovView;

typedef struct PovLight {
    double   position[3], target[3], color[3];
    bool     parallel, shadowless;
    unsigned line;
} PovLight;

typedef struct PovReader {
    WordReader words;
    Import    *import;
    int        depth;
    struct {
        PovName *items;
        size_t   count, capacity;
    } names;
    struct {
        PovLight *items;
        size_t    count, capacity;
    } lights;
    Part    *shown;     /* a union of what the scene has */
    Text     materials; /* of looks that are more than a colour */
    size_t   material_count;
    PovView  view;
    bool     has_background;
    double   background[3];
    unsigned background_line;
} PovReader;

/* ---- values: import_pov_values.c ---- */

/* The last one of a name counts; NULL: there is none. */
PovName *pov_find(PovReader *reader, const char *name);
/* Whether the next word begins a number or a vector. */
bool pov_value_follows(PovReader *reader);
bool pov_value(PovReader *reader, PovValue *value);
bool pov_number(PovReader *reader, double *number);
bool pov_vector(PovReader *reader, double v[3]);
/* `color rgb <1, 0, 0>`, a vector, or a name. */
bool pov_color_follows(PovReader *reader);
bool pov_color(PovReader *reader, double color[3]);

/* ---- words: import_pov_words.c ---- */

bool pov_deeper(PovReader *reader);
/* From `{` to the `}` that belongs to it. */
bool pov_skip_block(PovReader *reader);
/* A word that is left out with a note, and the values or the block behind it. */
bool pov_leave_out(PovReader *reader, const char *what);
/* `translate`, `rotate`, `scale`, `matrix`: adds to a place in POV-Ray's space.  *taken: it was one
   of them. */
bool pov_place(PovReader *reader, Place *place, bool *taken);
/* In the space of scenes. */
void pov_point(const double q[3], double p[3]);

/* ---- looks: import_pov_looks.c ---- */

/* `pigment`, `finish`, `texture` and `material` with their blocks; *taken likewise. */
bool pov_look(PovReader *reader, PovLook *look, bool *taken);
/* The argument of `.paint`; NULL: the look says nothing. */
const char *pov_look_text(PovReader *reader, const PovLook *look);

/* ---- objects: import_pov_objects.c and import_pov_shapes.c ---- */

bool pov_object_follows(const PovReader *reader);
bool pov_object(PovReader *reader, Part **part);

/* What stands in the block of a shape before its modifiers. */
typedef bool PovBuild(PovReader *reader, unsigned line, Part **part);
PovBuild pov_sphere, pov_box, pov_cylinder, pov_cone, pov_torus, pov_plane, pov_quadric, pov_cubic,
    pov_quartic, pov_poly;

/* ---- the view: import_pov_view.c ---- */

bool pov_camera(PovReader *reader);
bool pov_light(PovReader *reader);
bool pov_background(PovReader *reader);
void pov_write_view(PovReader *reader);

#endif
