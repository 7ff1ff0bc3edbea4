/*
 * krs.h: compile scenes and ask them questions.  No Vulkan is needed; rendering is in
 * vulkan.h.
 *
 * There is no global state.  A compiled scene never changes, so many threads may use it at the same
 * time.  What varies (the values of parameters, the time, zones of the caller) is in a KrsState,
 * which only one thread may use at a time.  Nothing here prints, exits or aborts.
 */
#ifndef KRS_H
#define KRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* The version of this header. */
#define KRS_VERSION       "0.2.0"
#define KRS_VERSION_MAJOR 0
#define KRS_VERSION_MINOR 2
#define KRS_VERSION_PATCH 0
/* Grows by 1 whenever the headers have something new: a function, a member, a choice. */
#define KRS_API_VERSION 3

/*
 * Structs that a program owns get new members, always behind the others: options, what is told of a scene, answers.
 * Functions with this word hand on how large such a struct is for the program (sized.h).  So a program that was
 * compiled with older headers runs with a newer library, which takes 0 for the members that the program does not know.
 * Those that the library does not know must be 0: else it is KRS_BAD_ARGUMENT.
 */
#ifdef KRS_LIBRARY /* this is the library itself */
#define KRS_SIZED __attribute__((visibility("hidden")))
#else
#define KRS_SIZED static inline
#endif

/*
 * Names of version 0.2 that are others now stay for one more, with a warning that says what to write instead (deprecated.h).  With
 * KRS_NO_DEPRECATION_WARNINGS compilers do not warn, and with KRS_NO_DEPRECATED there are no such names.
 */
#ifdef KRS_LIBRARY
#define KRS_NO_DEPRECATED
#endif
#if defined __GNUC__ && !defined KRS_NO_DEPRECATION_WARNINGS && !defined KRS_LIBRARY
#define KRS_DEPRECATED(instead) __attribute__((deprecated("use " instead)))
#else
#define KRS_DEPRECATED(instead)
#endif

/* A member, and the name that it had. */
#ifdef KRS_NO_DEPRECATED
#define KRS_WAS(member, old, instead) member
#elif defined __GNUC__
#define KRS_WAS(member, old, instead) \
    __extension__ union {             \
        member;                       \
        old KRS_DEPRECATED(instead);  \
    }
#else
#define KRS_WAS(member, old, instead) \
    union {                           \
        member;                       \
        old;                          \
    }
#endif

/* Returns the version of the library that a program runs with, as KRS_VERSION has it. */
const char *krs_version(void);

/* The numbers are also the exit statuses of the command `krs`. */
typedef enum KrsStatus {
    KRS_OK            = 0,
    KRS_BAD_SCENE     = 1,  /* diagnostics say why */
    KRS_BAD_ARGUMENT  = 2,  /* wrong use of this interface */
    KRS_NO_DEVICE     = 69, /* no usable Vulkan device */
    KRS_INTERNAL      = 70, /* a bug of krs or of the driver */
    KRS_OUT_OF_MEMORY = 71,
    KRS_CANNOT_CREATE = 73, /* an output cannot be created */
    KRS_IO_ERROR      = 74, /* the scene cannot be read, or an output cannot be written */
    KRS_RESUMABLE     = 75, /* of the command alone: interrupted, but what is done is kept */
    KRS_INTERRUPTED   = 130
} KrsStatus;

typedef struct KrsScene KrsScene;
typedef struct KrsState KrsState;

/* One diagnostic, as text ready to print and as one JSON object (field names of the Language
   Server Protocol).  The strings live until the callback returns. */
typedef struct KrsDiagnostic {
    bool        error, note; /* neither: a warning */
    const char *code;        /* "E0312" */
    const char *message;
    const char *source;       /* name of the text it is about */
    uint32_t    line, column; /* from 1 */
    const char *text, *json;
} KrsDiagnostic;

typedef void KrsDiagnosticCallback(void *user, const KrsDiagnostic *diagnostic);

/* Told now and then which part of the work is done, from 0 to 1, as far as one can say; in the thread that called the
   library.  False: stop, with KRS_INTERRUPTED. */
typedef bool KrsProgressCallback(void *user, double done);

/* Says where memory comes from; a zeroed struct means malloc and free.  It is called in the thread
   that calls the library.  It must outlive all objects that were made with it.  glslang and the
   Vulkan driver do not use it, nor do grids, sections and figures of parts, which several threads
   make. */
typedef struct KrsAllocator {
    void *(*allocate)(void *user, size_t size); /* NULL: out of memory; aligned as by malloc */
    void (*release)(void *user, void *block);
    void *user;
} KrsAllocator;

/* Supplies the text of a file that a scene uses, or reads as data; NULL: there is no such file.  `path` is the
   path that diagnostics show.  It begins with the scene's folder, if the scene's name does.  The
   text must stay valid until the next call, or until compiling has ended. */
typedef const char *KrsLoadCallback(void *user, const char *path, size_t *length);

/* Supplies a font that a scene names by its name, not by a file: "DejaVu Serif".  NULL is a usual one without serifs.
   Of several in the file, *face is the number of the one that is meant, 0 before the call.  NULL: there is none of this
   name.  The bytes must stay valid until the next call, or until compiling has ended. */
typedef const char *KrsFontCallback(void *user, const char *name, size_t *length, int *face);

/* Told of each file that a scene is read from: its own, what it uses or reads as data, pictures and
   fonts.  Also of files that do not exist, and perhaps of one more than once.  `path` is the one
   that diagnostics show; it lives until the callback returns. */
typedef void KrsOpenedCallback(void *user, const char *path);

/* A place of a text: bytes [start, end) of the file or text of this name. */
typedef struct KrsLocation {
    const char *source;
    uint32_t    start, end;
    uint32_t    line, column; /* of its beginning, from 1 */
} KrsLocation;

/* Says where numbers of the scene's text are in its shaders. */
typedef enum KrsSpecialize {
    KRS_SPECIALIZE_NUMBERS,   /* in their text, as literals: fast frames */
    KRS_SPECIALIZE_STRUCTURE, /* in the parameter block: a scene that differs in numbers alone has
                                 the same shaders, and compiles none */
    KRS_SPECIALIZE_AUTO       /* as NUMBERS at first, and as STRUCTURE from the first
                                 krs_scene_update on; still as NUMBERS where there are so
                                 many that drivers would take minutes */
} KrsSpecialize;

/* The memory that compiling a scene, or meshing a state, may use if nothing else is asked for: 2
   GiB. */
#define KRS_USUAL_MEMORY ((size_t)2 << 30)

typedef struct KrsOptions {
    KrsAllocator           allocator;
    KrsDiagnosticCallback *diagnostic; /* may be NULL */
    void                  *user;       /* handed to `diagnostic` */
    size_t        memory_limit; /* bytes that compiling a scene may use; 0: KRS_USUAL_MEMORY */
    KrsSpecialize specialize;
    bool          gradients; /* compile derivatives too: for KRS_NORMALS_ANALYTIC,
                                            and as krs_gradient in the GLSL */
    bool studio;   /* a bounded scene without lights and sky gets some, and a floor, whose component
                    is the last and named `floor`; for pictures */
    bool pictures; /* six large parts that are alike share code, too: shorter shaders and faster
                      frames, but meshes take longer; for pictures */
    bool assembly; /* keep what krs_assemble and krs_texture_uvs need, which takes some time */
    bool motion;   /* with `assembly`: what the time moves is taken apart, too */
    bool beams;    /* with `assembly`: keep what krs_component_beams needs */
    bool
        outlines; /* distances to polygons come from tables, however few corners they have: meshes of what is
                      revolved need fewer triangles and less time */
    bool
        figures; /* plane figures may be shown: each is made solid along z, about as high as it is long.  Its section
                      by the plane z = 0 is the figure */
    /* The folder of the files that are read; others are E0504, also behind symbolic links.  That
       includes the scene itself in krs_compile_file.  With krs_compile_text, `name` must be in the
       folder for `use` to work.  NULL: all files may be read. */
    const char *root;
    /* The text of the scene, where krs_compile_file has only its name: use krs_compile_text. */
    const char *text   KRS_DEPRECATED("krs_compile_text");
    size_t text_length KRS_DEPRECATED("krs_compile_text");
    KrsLoadCallback   *load;      /* supplies the files that are used; NULL: they are read */
    void              *load_user; /* handed to `load` */
    /* Called with each file that the scene is read from, so that the caller knows whether it must
       be compiled again, as after an edit.  The text of the scene and files of the standard library
       are not told of where they are not read from disk. */
    KrsOpenedCallback *opened;      /* may be NULL */
    void              *opened_user; /* handed to `opened` */
    bool research; /* compile steps for KRS_TRACE_TAYLOR and all methods behind it, too */
    /* Shapes that the expression at this place of the author's texts makes are empty, in their boxes: the scene without
       a part, to see what that costs.  Line and column do not count.  NULL: all are as they are written. */
    const KrsLocation *without;
    KrsFontCallback   *font;      /* supplies fonts; NULL: they are those of the system */
    void              *font_user; /* handed to `font` */
} KrsOptions;

/* Compiles a text in memory, or a file.  `name` is the text's name in diagnostics, and paths of
   `use` are relative to its folder.  Of the arguments only the allocator is used after the call,
   and by krs_scene_update the callbacks with what is handed to them.
   `options` may be NULL.  On KRS_OK the caller owns *scene; on any other status it is NULL.
   KRS_BAD_SCENE: see the diagnostics; KRS_IO_ERROR: the file cannot be read; KRS_OUT_OF_MEMORY. */
KRS_SIZED KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                                     const KrsOptions *options, KrsScene **scene);
KRS_SIZED KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene);
/* The states and renderings of the scene must be freed, or updated to another scene, before.  NULL
   is ignored, as in all functions that free. */
void krs_scene_free(KrsScene *scene);

/* Returns E0401: why no shader is made of the scene, for which drivers would take minutes; NULL:
   shaders are made.  It lives as long as the scene.  krs_text is refused, and so are renderings,
   but for previews by lanes of the host (KRS_EXECUTOR_LANES), which all previews are then.
   Answers, meshes, sections and grids need no shader. */
const KrsDiagnostic *krs_scene_too_large(const KrsScene *scene);

/*
 * Lays out the text of a scene in the canonical way, which docs/language.md describes: blanks change, but
 * no word, comment or break between lines.  It is a text in memory, or a file, as of krs_compile_text.  Of the options,
 * those count that say how the text is read; files that it uses are not read.
 *
 * On KRS_OK the caller releases *formatted by the allocator of the options, or by free() where there is none, and *same
 * says whether it is equal to the text that was read.  On any other status *formatted is NULL.  KRS_BAD_SCENE: the text is no scene, and
 * diagnostics say why; KRS_IO_ERROR: it cannot be read; KRS_OUT_OF_MEMORY.
 */
KRS_SIZED KrsStatus krs_format_text(const char *text, size_t length, const char *name,
                                    const KrsOptions *options, char **formatted, bool *same);
KRS_SIZED KrsStatus krs_format_file(const char *path, const KrsOptions *options, char **formatted,
                                    bool *same);

/*
 * Lists what a scene may use without defining it: what is built in, and what the library declares.  *json is an array with an
 * object for each:
 *
 *     kind        "function", "shape" (one that is declared by its distance), "method" of shapes, or "value"
 *     name
 *     parameters  but of values, a list of objects: `name`; `optional`, true where there is a default; `many`, true where it
 *                 takes all positional arguments; `takes`, a kind of values; `default` and `range` as the library writes them
 *     about       what it is or does; missing where nobody says
 *     file        "std/trees.krs", which a scene has to `use`; missing where each scene has it
 *
 * On KRS_OK the caller releases *json by the allocator, or by free() where that is NULL or has no function.  KRS_OUT_OF_MEMORY:
 * it is NULL.
 */
KrsStatus krs_words(const KrsAllocator *allocator, char **json);

/* The difference of an edited scene. */
typedef enum KrsChange {
    KRS_CHANGE_NOTHING,  /* but names, comments and blanks: pictures and distances are the same */
    KRS_CHANGE_VALUES,   /* numbers, colours, parameters, cameras, lights, image: shaders stay */
    KRS_CHANGE_STRUCTURE /* shaders must be compiled */
} KrsChange;

typedef struct KrsChanges {
    KrsChange kind;
    bool      parameters; /* their number, names, order, components, defaults or ranges */
    bool      components; /* their number or names */
    bool      cameras;    /* their number, names or properties */
    bool      lights;     /* lights, sky or fog */
    bool      image;      /* the `image` block */
    bool      solids;     /* what components enclose, or where their copies are */
    bool surfaces; /* that, or materials or names of it; else meshes are the same in every way */
} KrsChanges;

/*
 * Compiles an edited text of a scene.  The result is a new scene; the given one stays as it is, and
 * other threads may use it meanwhile.  Name, options and root are those of the first compilation,
 * so that diagnostics go where they went, and files of `use` are read again.
 *
 * On KRS_OK the caller owns *updated, and *changes (unless NULL) says what is different.  On any
 * other status *updated is NULL, as of krs_compile_text.
 *
 * States and renderings belong to the scene that they were made of.  krs_state_update and
 * krs_rendering_update (vulkan.h) take them over to the new one.
 */
KRS_SIZED KrsStatus krs_scene_update(const KrsScene *scene, const char *text, size_t length,
                                     KrsScene **updated, KrsChanges *changes);

/* Does the same with the scene's own file as it is now, which is read by the rules of the first
   compilation, and told of to KrsOptions.opened.  KRS_IO_ERROR: it cannot be read. */
KRS_SIZED KrsStatus krs_scene_reload(const KrsScene *scene, KrsScene **updated,
                                     KrsChanges *changes);

/* Strings that the functions below return (names, places, rules) live as long as the scene. */

/* A `param` of the scene.  Angles are in radians, colours linear Rec.709. */
typedef struct KrsParameter {
    const char *name;
    uint32_t    components;      /* 1 for a number, 2..4 for a vector or colour */
    double      value[4];        /* the default */
    double      low[4], high[4]; /* the permitted range; may be infinite */
    int         degrees;         /* the text gives its default or range in degrees */
    bool        color;           /* the text gives its default as a colour */
    bool        whole; /* the text gives its range as that of the numbers 0 and 1: `0..2` */
    const char *doc;   /* its comment of `///` lines, or NULL */
    /* The default stands in bytes [start, end) of the file or text of this name. */
    const char *source;
    uint32_t    start, end;
    uint32_t    line, column; /* of the name, from 1 */
} KrsParameter;

size_t krs_parameter_count(const KrsScene *scene);
/* Finds parameter `index` in the order of the text; KRS_BAD_ARGUMENT when there is none. */
KRS_SIZED KrsStatus krs_parameter(const KrsScene *scene, size_t index, KrsParameter *parameter);

/* The properties of the `image` block; 0 or NULL where one is not given. */
typedef struct KrsImage {
    uint32_t    width, height, samples;
    uint32_t    bounces;      /* of a path, at most */
    const char *integrator;   /* "preview", "direct", "path", or NULL */
    double      exposure;     /* in stops; 0 changes nothing */
    const char *tone_map;     /* or NULL */
    double      error;        /* permitted distance from the surface in pixels; 0: the default */
    double      noise;        /* error at which samples of a pixel end; 0: none */
    const char *pixel_filter; /* or NULL */
    double      white_balance[2]; /* the white of the light: kelvins, tint; 0: as it is */
} KrsImage;
KRS_SIZED KrsImage krs_scene_image(const KrsScene *scene);

/* Makes a state: parameters at their defaults, time 0, no zones of the caller.  The scene must
   outlive the state.  KRS_OUT_OF_MEMORY: *state is NULL. */
KrsStatus krs_state_new(const KrsScene *scene, KrsState **state);
void      krs_state_free(KrsState *state);
/* Takes a state over to an update of its scene, or to one that its scene is an update of.  Time and
   zones stay.  Parameters that were set keep their value where the other scene has one of this name
   that permits it; all others have the other scene's default.  A time that the other scene refuses
   becomes 0.  KRS_OUT_OF_MEMORY: the state is unchanged. */
KrsStatus krs_state_update(KrsState *state, const KrsScene *scene);
/* Sets all `count` components of a parameter, or the time in seconds.  KRS_BAD_ARGUMENT, and the
   state is unchanged: there is no such parameter, it has another number of components, a value is
   outside of its range or not finite, or a number of the scene would not be finite. */
KrsStatus krs_state_set(KrsState *state, const char *name, const double *values, size_t count);
KrsStatus krs_state_set_time(KrsState *state, double time);
double    krs_state_time(const KrsState *state);
/* Moves the camera of a scene that has none so that all is in the picture at the values and the time of
   the state; until then that holds for the defaults and time 0.  Other scenes are left as they are. */
KrsStatus krs_state_fit_camera(KrsState *state);
/* Returns the location ("scene.krs:3:14") of an expression whose slope has no bound for the last
   value or time, which was refused for that reason.  NULL if it was accepted, or refused for
   another one. */
const char *krs_state_unbounded(const KrsState *state);

/* The languages in which a scene is printed, a row of targets.def each. */
typedef enum KrsTarget {
#define KRS_TARGET(id, name, about) KRS_TARGET_##id,
#include "krs/targets.def"
    KRS_TARGET_COUNT
} KrsTarget;

/* Texels of a row of the textures that ESSL reads: texel i is in column i % 4096 of row i / 4096. */
enum { KRS_TEXTURE_WIDTH = 4096 };

/* Zero asks for what `krs compile` writes. */
typedef struct KrsTextOptions {
    bool
        state_values; /* what depends on the state alone is read from the slots of krs_state_values */
    bool
        no_early_outs; /* for devices with few threads: no branch skips what is far away, and there is no
                           krs_distance_lod */
} KrsTextOptions;

/*
 * Writes the text of a scene, for engines that have shaders of their own: functions for its
 * distance and its surface, and all that they need (docs/library.md).  It is the same for all
 * states.  `options` may be NULL.  On KRS_OK the caller releases *text by the allocator of the
 * scene's options, or by free() where there is none.  On any other status it is NULL: KRS_BAD_SCENE
 * (krs_scene_too_large), KRS_BAD_ARGUMENT, KRS_OUT_OF_MEMORY.
 */
KRS_SIZED KrsStatus krs_text(const KrsScene *scene, KrsTarget target, const KrsTextOptions *options,
                             char **text);

/*
 * Writes the uniforms of that text, for programs that embed it.  Each slot is a
 * vec4; `block` needs krs_parameter_slots of them.  Slot 0 is (time, 0, 0, 0).  A slot for each
 * parameter follows, in the order of krs_parameter.  The last slots are slopes, in x, which are
 * computed for each state.  Distances are divided by them where no constant is safe, as for
 * sin(time * x).  With KrsOptions.studio the height of the floor may be behind them.
 */
size_t krs_parameter_slots(const KrsScene *scene);
void   krs_state_parameters(const KrsState *state, float (*block)[4]);
/*
 * Returns how many more slots the text has behind those with KrsTextOptions.state_values.  They are
 * for other values that depend on the state alone, such as rotations by a parameter and sines of
 * the time.  So these are not computed at each point, which saves registers, and they are computed
 * in double precision.
 */
size_t krs_value_slots(const KrsScene *scene);
void   krs_state_values(const KrsState *state, float (*block)[4]);
/*
 * Writes the texel buffers of that text: numbers of parts that are alike but for numbers, and which of them
 * are near a point.  `rows` needs krs_table_rows texels, for krs_rows (RGBA32F), and `cells` needs
 * krs_table_cells, for krs_cells (RG32UI), which has the textures as well.  Both are 0 for scenes
 * without such parts and textures, whose GLSL has neither buffer.  Both may depend on the parameters and the time.
 */
size_t krs_table_rows(const KrsScene *scene);
size_t krs_table_cells(const KrsScene *scene);
void   krs_state_tables(const KrsState *state, float (*rows)[4], uint32_t (*cells)[2]);
/* A texture that the scene names.  Its texels are in `cells`, level after level, the rows of each from
   the bottom upwards; a level has half the width and height of the one before, rounded down.  Those
   of a gray texture are two floats, gray and alpha, those of others four halves, red, green, blue and
   alpha.  KRS_BAD_ARGUMENT: there is none of this index. */
typedef struct KrsTexture {
    const char *file;
    uint32_t    width, height, levels;
    int         gray;
    size_t      header; /* texel of its header, which the GLSL reads */
    size_t      first;  /* first texel of its finest level */
} KrsTexture;
size_t              krs_texture_count(const KrsScene *scene);
KRS_SIZED KrsStatus krs_texture(const KrsScene *scene, size_t index, KrsTexture *texture);
/* A slope that is computed for each state: its slot, and the location of its expression.
   KRS_BAD_ARGUMENT: there is none of this index. */
typedef struct KrsStateSlope {
    uint32_t slot;
    KRS_WAS(const char *location, const char *place, "location"); /* "scene.krs:3:14" */
    double low[3], high[3]; /* the box for which the slope holds; may be infinite */
} KrsStateSlope;
size_t              krs_state_slope_count(const KrsScene *scene);
KRS_SIZED KrsStatus krs_state_slope(const KrsScene *scene, size_t index, KrsStateSlope *slope);

/*
 * Sets the caller's zones: spheres (center and radius) that are kept empty, so that the caller can
 * put its own things there.  The spheres are subtracted from all solids; a cut surface has the
 * component and material of its solid.  These zones replace those of the previous call.  Zones that
 * the scene declares stay.
 * KRS_BAD_ARGUMENT, and the state is unchanged: there are more than KRS_MAX_ZONES, a radius is
 * negative, or a number is not finite or beyond KRS_MAX_COORDINATE.
 */
#define KRS_MAX_ZONES      16
#define KRS_MAX_COORDINATE 1e18 /* single precision can square it */
KrsStatus krs_state_set_zones(KrsState *state, const double (*zones)[4], size_t count);

typedef enum KrsProjection {
#define KRS_PROJECTION(id, name) KRS_##id,
#include "krs/camera.def"
} KrsProjection;

/* The numbers of a member, by its kind in camera.def. */
#define KRS_CAMERA_place [3]
#define KRS_CAMERA_axis  [3]
#define KRS_CAMERA_pair  [2]
#define KRS_CAMERA_angle
#define KRS_CAMERA_number
#define KRS_CAMERA_focus

/* The position and projection of a camera, a member for each row of camera.def. */
typedef struct KrsCamera {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) double name KRS_CAMERA_##kind;
#define KRS_CAMERA_FIXED(name, type, part, counts)          type name;
#include "krs/camera.def"
} KrsCamera;

/* Return the cameras that the scene declares or, if it has none, one that the compiler places.  The
   first is the default.  The name is NULL if the camera has none, and lives as long as the scene. */
size_t      krs_camera_count(const KrsScene *scene);
const char *krs_camera_name(const KrsScene *scene, size_t index);
/* Finds the place of a camera's block in the text, from `camera` to behind the `}`.
   KRS_BAD_ARGUMENT: there is no such camera, or the compiler places it. */
KRS_SIZED KrsStatus krs_camera_location(const KrsScene *scene, size_t index, KrsLocation *location);
/* Finds a camera at the state's parameters and time.  KRS_BAD_ARGUMENT when there is none of that
   index. */
KRS_SIZED KrsStatus krs_state_camera(KrsState *state, size_t index, KrsCamera *camera);

/* A component of the scene: what one `show` shows. */
typedef struct KrsComponent {
    const char *name;            /* of the variable in its `show`, or "component 3" */
    double      low[3], high[3]; /* a box around it in world units; may be infinite */
    double      slope;           /* the derived bound on the slope of its expression */
    KRS_WAS(bool per_state, bool per_frame,
            "per_state");   /* `slope` is that of the first state; each has its own */
    bool        exact;      /* the distance is exact outside wherever docs/math.md says so */
    bool        estimate;   /* nothing is proven of the distance; else it is a bound */
    bool        figure;     /* a plane figure: KrsOptions.figures */
    uint32_t    levels;     /* number of reflections of its outermost sequence, or 0 */
    double      instances;  /* number of generators with all their copies */
    uint32_t    inversions; /* maps that invert, in its outermost sequence or `.transform` */
    double      flops;      /* multiply-adds to evaluate its distance at a point; its share
                                    where many that are alike are evaluated together */
    KrsLocation location;   /* of the expression that is shown; zeros where the library shows it */
} KrsComponent;

size_t krs_component_count(const KrsScene *scene);
/* Finds component `index`, from 0 in the order of the text; KRS_BAD_ARGUMENT when there is none. */
KRS_SIZED KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component);

/* Names of the scene's materials, each once, for the numbers that answers and mattes have: from 1 on.
   Plain colours are all "colour".  NULL where there is no such number: nothing is painted. */
size_t      krs_material_count(const KrsScene *scene);
const char *krs_material_name(const KrsScene *scene, size_t number);

/* The bounds of the distance of one shape of a component, in the shape's own space. */
typedef struct KrsBound {
    uint32_t    depth;           /* 0: the whole component; its parts follow, with 1, and so on */
    const char *name;            /* "torus", "union" */
    const char *source;          /* name of the text where the shape is made */
    uint32_t    line, column;    /* position there, from 1; 0: none */
    const char *rule;            /* why its bound holds: "exact, by claim" */
    double      slope;           /* of its distance; the component's distance is divided by it */
    double      low[3], high[3]; /* a box around it; may be infinite */
    bool        exact, estimate; /* as in KrsComponent, like the next two */
    uint32_t    levels;
    double      instances;
    /* The parts of the same structure, made at the same place, that have no entry. */
    KRS_WAS(uint32_t similar, uint32_t alike, "similar");
    size_t      same;       /* number from 1 of the entry that lists its parts; 0: this one */
    uint32_t    start, end; /* bytes of `source`; zeros where that is a text of the library */
    const char *given;      /* what the author calls it, by the `let` that has it first; or NULL */
} KrsBound;

/* Returns the number of entries, at most 256; 0 if there is no such component. *more, unless NULL,
   becomes the number of shapes for which there was no room. */
size_t krs_bound_count(const KrsScene *scene, size_t component, size_t *more);
/* Finds a bound of a component; KRS_BAD_ARGUMENT when there is no such entry. */
KRS_SIZED KrsStatus krs_bound(const KrsScene *scene, size_t component, size_t index,
                              KrsBound *bound);

/*
 * Queries of a state, in double precision.  Arrays belong to the caller and have `count` elements;
 * 0 is permitted.  If a number is not valid (coordinates must be finite) a query returns
 * KRS_BAD_ARGUMENT and writes nothing.
 */

/* Finds the distances of `count` points in world units: never above the distance to the nearest
   surface, negative inside.  +infinity in a scene with nothing in it. */
KrsStatus krs_distance(KrsState *state, const double (*points)[3], size_t count, double *distances);
/* Finds unit gradients of the distance, outwards; 0 where there is none. */
KrsStatus krs_normal(KrsState *state, const double (*points)[3], size_t count,
                     double (*normals)[3]);

/* The numbers of a member, by its type in surface.def. */
#define KRS_NUMBERS_FLOAT
#define KRS_NUMBERS_VEC3 [3]

/* The distance and surface at a point, or where a ray ends. */
typedef struct KrsHit {
    bool   hit;        /* for rays; always true for points */
    bool   unresolved; /* for rays: ended after KRS_MAX_STEPS steps; nothing before `t` */
    double t;          /* for rays: world units along the unit direction */
    double point[3];
    double distance;   /* at that point */
    double normal[3];  /* unit gradient of the distance; 0 where there is none */
    double shading[3]; /* the normal for lighting; differs from `normal` where mirrors are smooth
                            over a given width */
    /* A member for each row of surface.def: which part was hit, and its material.
       component: from 1; 0 where nothing is hit;
       level: number of mirrors that the instance comes through; instance: its number (docs/math.md,
       section 1), a hash beyond 31 mirrors, 1 without a sequence; material: the number of its name; color[3] and emission[3]: linear
       Rec.709; roughness; metallic.  All but the emission are limited as in pictures. */
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) uint32_t name;
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    double name KRS_NUMBERS_##type;
#include "krs/surface.def"
} KrsHit;

/* Finds distance, normal and identity at points. */
KRS_SIZED KrsStatus krs_probe(KrsState *state, const double (*points)[3], size_t count,
                              KrsHit *hits);

/*
 * First hits of rays in [0, farthest], which may be infinite; directions of any length but 0.
 *
 * A ray hits where the distance is not above 0, so the tolerance makes nothing thicker.  The
 * tolerance, in world units (0: 1e-9), is how far `t` may be from where the ray crosses the
 * surface. A ray may miss a solid in which it stays for less than a sixteenth of the tolerance,
 * as where it grazes one.  Both lengths grow by the rounding of the coordinates.  A ray from
 * inside of a solid hits the solid's surface from inside; one that begins on a surface hits it at
 * 0.
 *
 * A ray that has not ended after KRS_MAX_STEPS steps is neither a hit nor a miss.  It is
 * `unresolved`, and no surface is before `t`.  This happens to rays that stay very near to a
 * surface, for example along an infinite plane.
 */
#define KRS_MAX_STEPS 100000
KRS_SIZED KrsStatus krs_raycast(KrsState *state, const double (*origins)[3],
                                const double (*directions)[3], size_t count, double farthest,
                                double tolerance, KrsHit *hits);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#include "krs/light.h"
#include "krs/grid.h"
#include "krs/mesh.h"
#include "krs/slice.h"
#include "krs/measure.h"
#include "krs/sized.h"
#ifndef KRS_NO_DEPRECATED
#include "krs/deprecated.h"
#endif
#endif
