/*
 * parts.h: what is known of an export, and the pieces that templates have.
 */
#ifndef KRS_EXPORT_PARTS_H
#define KRS_EXPORT_PARTS_H

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

#include "compiler/scene/program.h"
#include "export/export.h"

/* What a scene is sampled to (bake.c). */
typedef struct Baked Baked;

typedef struct Export {
    const KrsScene     *scene;
    KrsState           *state;
    const ExportTarget *target;
    const char         *name; /* of the scene */
    const char         *stem; /* of the files, without their endings */
    KrsView             view;
    float (*block)[4];
    const Baked *baked; /* NULL: the scene is a text */
    const char  *text;  /* of the scene, in the language of the target */
} Export;

/* Fills the template of this name. */
void export_fill(Text *to, const Export *export, const char *template);

/* Tells whether a text begins with a word. */
static inline bool begins(const char *text, const char *word)
{
    return strncmp(text, word, strlen(word)) == 0;
}

/* Tells whether names have such characters. */
static inline bool is_of_word(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* ---- numbers.c ---- */
/* These add a number with a point, and "vec3(1.0, 0.5, 0.0)" in words of the target. */
void add_float(Text *to, double number);
void add_vector(Text *to, const Export *export, const double *numbers, int count);

/* ---- view.c: what is known of camera, lights and sky ---- */
/* Returns half the height of the picture at distance 1. */
double find_rise(const KrsCamera *camera);
/* Finds what is up in the picture; of a camera that looks along its own, another axis. */
void find_upright(const KrsCamera *camera, double up[3]);
/* Returns how far from the eye there may be something. */
double find_farthest(const Export *export);
/* Finds the box of the scene, or of its samples. */
void find_extent(const Export *export, double low[3], double high[3]);
/* Finds the same; where that has no end, a hundred times as far as
   the camera looks. */
void find_box(const Export *export, double low[3], double high[3]);
void add_constants(Text *to, const Export *export);
void add_farthest(Text *to, const Export *export);
void add_camera(Text *to, const Export *export);

/* ---- bake.c ---- */
/* Samples the scene.  KRS_BAD_ARGUMENT: `why` says what hinders it. */
KrsStatus bake_scene(Export *export, const ExportOptions *options, Arena *arena, Text *why);
/* Return how many parameters the text has, and how many slots: samples have none, and the time. */
size_t exported_parameters(const Export *export);
size_t exported_slots(const Export *export);
/* Finds the box of the samples. */
void                 find_baked_box(const Export *export, double low[3], double high[3]);
const unsigned char *baked_bytes(const Export *export, size_t *length);
/* Adds a file that has them. */
void add_baked_file(Text *to, const Export *export);
void add_baked_low(Text *to, const Export *export);
void add_baked_size(Text *to, const Export *export);
void add_baked_cell(Text *to, const Export *export);
void add_baked_count(Text *to, const Export *export);
void add_baked_sampler(Text *to, const Export *export);
void add_normal_reach(Text *to, const Export *export);

/* ---- parameters.c ---- */
KrsParameter parameter_of(const Export *export, size_t index);
/* Tells whether a parameter is one number with both ends, so that a slider sets it; and whether it is a colour. */
bool has_slider(const KrsParameter *parameter);
bool is_color(const KrsParameter *parameter);
/* Adds a name for a parameter, behind a prefix. */
void add_parameter_name(Text *to, const char *prefix, const char *name, size_t slot);
void add_constant_parameters(Text *to, const Export *export);
void set_constant_parameters(Text *to, const Export *export);
void add_parameters_json(Text *to, const Export *export);
void add_parameter_lines(Text *to, const Export *export);
void add_block(Text *to, const Export *export);
void add_defaults(Text *to, const Export *export);

/* ---- tables.c: of parts that are alike, and textures ---- */
bool has_tables(const Export *export);
/* Returns krs_rows, or krs_cells, as bytes. */
const unsigned char *table_bytes(const Export *export, bool rows, size_t *length, Arena *arena);
void                 add_rows(Text *to, const Export *export);
void                 add_cells(Text *to, const Export *export);
void                 add_baked_text(Text *to, const Export *export);

/* ---- languages.c ---- */
/* Finds the scene's text in the language of the target.  KRS_BAD_ARGUMENT: `why` says what hinders it. */
KrsStatus find_scene_text(Export *export, Arena *arena, Text *why);
/* Adds what marches go by, as an expression of p and `footprint`. */
void add_march(Text *to, const Export *export);

/* ---- frames.c ---- */
/* Adds a text without globals that change, as Godot wants it: what is found once for a picture is a struct, KrsFrame, that
   krs_prepare returns, and that functions which need it are given.  `prepared` are statements that fill its slots in, perhaps
   from parameters that krs_prepare is `given`.  Prototypes are left out. */
void add_without_globals(Text *to, const char *text, size_t slots, const char *given,
                         const char *prepared);

/* ---- godot.c ---- */
void add_godot_uniforms(Text *to, const Export *export);
void set_godot_parameters(Text *to, const Export *export);
void add_godot_nodes(Text *to, const Export *export);
/* Adds the colours of the sky. */
void add_godot_sky(Text *to, const Export *export);
/* These add the box: its middle, half of its sides; the same as plain numbers, and as a size. */
void add_center(Text *to, const Export *export);
void add_half(Text *to, const Export *export);
void add_center_numbers(Text *to, const Export *export);
void add_size_numbers(Text *to, const Export *export);

/* ---- unity.c ---- */
void add_unity_properties(Text *to, const Export *export);
void add_unity_uniforms(Text *to, const Export *export);
void add_unity_parameters(Text *to, const Export *export);
void add_unity_fields(Text *to, const Export *export);
void add_unity_sets(Text *to, const Export *export);
void add_unity_class(Text *to, const Export *export);
void add_unity_center(Text *to, const Export *export);
void add_unity_half(Text *to, const Export *export);
void add_unreal_inputs(Text *to, const Export *export);
void add_unreal_parameters(Text *to, const Export *export);

/* ---- osl.c ---- */
/* Adds a text in ESSL without globals in the Open Shading Language. */
void add_osl(Text *to, const char *text);

/* ---- blender.c ---- */
void add_osl_given(Text *to, const Export *export);
void add_osl_passed(Text *to, const Export *export);
void add_osl_values(Text *to, const Export *export);
void set_osl_parameters(Text *to, const Export *export);
void add_osl_parameters(Text *to, const Export *export);
void add_seconds(Text *to, const Export *export);
void add_python_camera(Text *to, const Export *export);
void add_python_lights(Text *to, const Export *export);
void add_python_sky(Text *to, const Export *export);

/* ---- cross.c ---- */
/* Adds GLSL in another language, by spirv-cross.  KRS_BAD_ARGUMENT: `why` says what is missing. */
KrsStatus cross_compile(const char *glsl, const char *const *options, Text *to, Text *why);

#endif
