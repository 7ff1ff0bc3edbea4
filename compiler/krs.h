/*
 * krs.h: compile scenes and ask them questions.  No Vulkan is needed; rendering is in
 * krs_vulkan.h.
 *
 * There is no global state: different scenes may be used from different threads, and one
 * scene, which never changes once compiled, from many.  What varies from frame to frame (the
 * values of parameters, the time) lives in a KrsFrame, which belongs to one thread at a time.
 * Nothing here prints, exits or aborts.
 */
#ifndef KRS_H
#define KRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define KRS_VERSION "0.1.0"

/* The command's exit statuses are these numbers too. */
typedef enum KrsStatus {
    KRS_OK            = 0,
    KRS_BAD_SCENE     = 1,  /* diagnostics say why */
    KRS_BAD_ARGUMENT  = 2,  /* wrong use of this interface */
    KRS_NO_DEVICE     = 69, /* no usable Vulkan device */
    KRS_INTERNAL      = 70, /* a bug of krs or of the driver */
    KRS_OUT_OF_MEMORY = 71,
    KRS_CANNOT_CREATE = 73, /* an output cannot be created */
    KRS_IO_ERROR      = 74, /* the scene cannot be read, or an output not be written */
    KRS_INTERRUPTED   = 130
} KrsStatus;

typedef struct KrsScene KrsScene;
typedef struct KrsFrame KrsFrame;

/* One diagnostic, as text ready to print and as one JSON object (field names of the Language
   Server Protocol).  The strings live until the callback returns. */
typedef struct KrsDiagnostic {
    bool        error; /* else a warning */
    const char *code;  /* "E0312" */
    const char *message;
    const char *source;       /* name of the text it is about */
    uint32_t    line, column; /* from 1 */
    const char *text, *json;
} KrsDiagnostic;

typedef void KrsDiagnosticCallback(void *user, const KrsDiagnostic *diagnostic);

/* Where memory comes from; zero means malloc and free.  It is called by the thread that calls the
   library, and must last as long as what was made with it.  glslang and the Vulkan driver have
   their own. */
typedef struct KrsAllocator {
    void *(*allocate)(void *user, size_t size); /* NULL when there is none; aligned as malloc */
    void (*release)(void *user, void *block);
    void *user;
} KrsAllocator;

/* Supplies the text of a file that a scene uses, by the path that diagnostics show: relative to the
   scene's folder, as the scene's own name is given.  NULL: there is none.  The text must stay until
   the next call, or until compiling has ended. */
typedef const char *KrsLoadCallback(void *user, const char *path, size_t *length);

typedef struct KrsOptions {
    KrsAllocator           allocator;
    KrsDiagnosticCallback *diagnostic;   /* may be NULL */
    void                  *user;         /* handed to `diagnostic` */
    size_t                 memory_limit; /* of a scene, while it is compiled; bytes; 0: 2 GiB */
    bool                   gradients;    /* derivatives as well, for KRS_NORMALS_ANALYTIC and for
                                            whoever embeds the GLSL: krs_gradient */
    /* Files are read from this folder and those below only, whatever a scene names and wherever
       symbolic links lead: E0504.  That goes for the scene itself in krs_compile_file; with
       krs_compile_text, `name` must be in it for `use` to work.  NULL: any. */
    const char      *root;
    KrsLoadCallback *load;      /* instead of reading files that are used; may be NULL */
    void            *load_user; /* handed to `load` */
} KrsOptions;

/* Compiles a text in memory (`name` is used in diagnostics, and `use` is relative to its
   folder) or a file.  Nothing of the arguments is kept but the allocator.  On KRS_OK the caller
   owns *scene; on any other status it is NULL.  `options` may be NULL.  KRS_BAD_SCENE: see the
   diagnostics; KRS_IO_ERROR: the file cannot be read; KRS_OUT_OF_MEMORY. */
KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                           const KrsOptions *options, KrsScene **scene);
KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene);
/* Its frames and renderings must be freed before.  NULL is ignored, here as in all that frees. */
void krs_scene_free(KrsScene *scene);

/* What the functions below say of a scene lives as long as the scene: names, places, rules. */

/* A `param` of the scene.  Angles are in radians, colours linear Rec.709. */
typedef struct KrsParameter {
    const char *name;
    uint32_t    components;      /* 1 for a number, 2..4 for a vector or colour */
    double      value[4];        /* the default */
    double      low[4], high[4]; /* the permitted range; may be infinite */
} KrsParameter;

size_t krs_parameter_count(const KrsScene *scene);
/* Parameter `index` in the order of the text; KRS_BAD_ARGUMENT when there is none. */
KrsStatus krs_parameter(const KrsScene *scene, size_t index, KrsParameter *parameter);

/* Parameters at their defaults, time 0, no zones of the caller.  The scene must outlive the frame.
   KRS_OUT_OF_MEMORY: *frame is NULL. */
KrsStatus krs_frame_new(const KrsScene *scene, KrsFrame **frame);
void      krs_frame_free(KrsFrame *frame);
/* Gives a parameter all of its `count` components; the time is in seconds.  KRS_BAD_ARGUMENT when
   there is no such parameter or it has another number of components, one is outside of its range
   or not finite, or something in the scene is not finite for it; the frame is then unchanged. */
KrsStatus krs_frame_set(KrsFrame *frame, const char *name, const double *values, size_t count);
KrsStatus krs_frame_set_time(KrsFrame *frame, double time);
/* Of the last value or time that was refused: the place of an expression ("scene.krs:3:14") whose
   slope has no bound for it; NULL when that was not why, or the last one was taken. */
const char *krs_frame_unbounded(const KrsFrame *frame);

/*
 * The uniforms of the GLSL that `krs compile` writes, for who embeds it: a vec4 for each slot, of
 * which `block` has room for krs_parameter_slots.  Slot 0 has the time, as (time, 0, 0, 0), then
 * there is one for each parameter, in the order of krs_parameter.  Behind them are slopes, numbers
 * in x, that are found for each frame: what distances are divided by where no constant is safe, as
 * in sin(time * x).
 */
size_t krs_parameter_slots(const KrsScene *scene);
void   krs_frame_parameters(const KrsFrame *frame, float (*block)[4]);
/*
 * With `krs compile --frame-values on`, that GLSL reads what else depends on the frame alone (turns
 * by a parameter, sines of the time) from krs_value_slots more slots, behind those, instead of
 * finding it for each point anew: fewer registers, and the digits of double precision.
 */
size_t krs_value_slots(const KrsScene *scene);
void   krs_frame_values(const KrsFrame *frame, float (*block)[4]);
/* The slot of slope `index`, and the place of its expression; KRS_BAD_ARGUMENT when there is
   none. */
typedef struct KrsFrameSlope {
    uint32_t    slot;
    const char *place;           /* "scene.krs:3:14" */
    double      low[3], high[3]; /* of the box over which it is found; may be infinite */
} KrsFrameSlope;
size_t    krs_frame_slope_count(const KrsScene *scene);
KrsStatus krs_frame_slope(const KrsScene *scene, size_t index, KrsFrameSlope *slope);

/*
 * Empty zones: spheres (center and radius) within which nothing of the scene is, so that the
 * caller can put something of its own there.  Solids end at a zone as if the sphere had been
 * subtracted; the cut shows the component, and the material, that it goes through.  These zones
 * add to those that the scene declares, and replace those of the call before.
 * KRS_BAD_ARGUMENT when there are more than KRS_MOST_ZONES, a radius is negative, or a number is
 * not finite or beyond 1e18; the frame is then unchanged.
 */
#define KRS_MOST_ZONES 16
KrsStatus krs_frame_set_zones(KrsFrame *frame, const double (*zones)[4], size_t count);

/* A component of the scene: what one `show` shows. */
typedef struct KrsComponent {
    const char *name;            /* the variable it was shown by, or "component 3" */
    double      low[3], high[3]; /* a box around it in world units; may be infinite */
    double      slope;           /* the derived bound on the slope of its expression */
    bool        per_frame;       /* that is of the first frame, and found anew for each */
    bool        exact;           /* the distance is exact outside wherever docs/math.md says so */
    bool        estimate;        /* nothing is proven of the distance; else it is a bound */
    uint32_t    levels;          /* reflections of its outermost sequence; 0 without one */
    double      instances;       /* copies of kernels, counted with their reflections */
    uint32_t    inversions; /* maps of its outermost sequence that invert, or of `.transform` */
    double      flops;      /* of its distance, at one point: in multiply-adds */
} KrsComponent;

size_t krs_component_count(const KrsScene *scene);
/* Component `index`, from 0 in the order of the text; KRS_BAD_ARGUMENT when there is none. */
KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component);

/* What is known of the distance of one shape of a component, in the shape's own space. */
typedef struct KrsBound {
    uint32_t    depth;           /* 0: all of the component; its parts follow it, one deeper */
    const char *name;            /* "torus", "union" */
    const char *source;          /* where the shape is made: name of a text, */
    uint32_t    line, column;    /* from 1; 0: nowhere */
    const char *rule;            /* by which its bound follows: "exact, by claim" */
    double      slope;           /* of the distance that it lowers to; divided out at the root */
    double      low[3], high[3]; /* a box around it; may be infinite */
    bool        exact, estimate; /* as of components */
    uint32_t    levels;
    double      instances;
    uint32_t    alike; /* parts like it, made in the same place, that have no entry */
    size_t      same;  /* from 1: the entry where its parts are; 0: behind this one */
} KrsBound;

/* How many entries there are, at most 256, and how many shapes there was no room for (`more` may be
   NULL); 0 of a component that does not exist. */
size_t krs_bound_count(const KrsScene *scene, size_t component, size_t *more);
/* KRS_BAD_ARGUMENT when there is no such entry. */
KrsStatus krs_bound(const KrsScene *scene, size_t component, size_t index, KrsBound *bound);

/*
 * Questions about a frame, in double precision.  Arrays have `count` elements, which may be 0, and
 * are the caller's.  All are KRS_BAD_ARGUMENT, and answer nothing, when a number among the
 * arguments is not what it must be: coordinates are finite.
 */

/* Distances for `count` points in world units: never above the distance to the nearest surface,
   negative inside.  +infinity in a scene with nothing in it. */
KrsStatus krs_distance(KrsFrame *frame, const double (*points)[3], size_t count, double *distances);
/* Unit gradients of the distance, outwards; 0 where there is none. */
KrsStatus krs_normal(KrsFrame *frame, const double (*points)[3], size_t count,
                     double (*normals)[3]);

/* What is at a point, or where a ray ends. */
typedef struct KrsHit {
    bool     hit;        /* for rays; always true for points */
    bool     unresolved; /* for rays: given up after KRS_MOST_STEPS steps, clear up to `t` */
    double   t;          /* for rays: world units along the unit direction */
    double   point[3];
    double   distance;  /* at that point */
    double   normal[3]; /* unit gradient of the distance; 0 where there is none */
    uint32_t component; /* from 1; 0 where nothing is hit */
    uint32_t level;     /* reflections before the kernel */
    uint32_t instance;  /* docs/math.md, section 1: a number of its own for each copy, or, beyond
                           31 mirrors, a hash; 1 without a sequence */
    double   color[3];  /* linear Rec.709 */
    double   roughness, metallic;
    double   shading[3]; /* the normal that light sees: `normal`, unless mirrors are smooth over a
                            width of their own */
} KrsHit;

/* Distance, normal and identity at points. */
KrsStatus krs_probe(KrsFrame *frame, const double (*points)[3], size_t count, KrsHit *hits);

/*
 * First hits of rays in [0, farthest], which may be infinite; directions of any length but 0.
 *
 * A ray hits where the distance is not above 0, so things are as thick as they are, whatever the
 * tolerance.  The tolerance, in world units (0: 1e-9), says how far `t` may be from where the
 * surface is crossed; a sixteenth of it is the length of a way through a solid that may be
 * overlooked, as where a ray grazes one.  Both grow by what coordinates of that size are rounded
 * by.  A ray from inside of a solid sees the solid's inner wall; one that begins on a surface hits
 * it at 0.
 *
 * A ray that comes so near to surfaces for so long that KRS_MOST_STEPS distances do not bring it
 * to an end (as within a hair's breadth of an endless plane) is neither hit nor miss: it is
 * `unresolved`, and nothing is before `t`.
 */
#define KRS_MOST_STEPS 100000
KrsStatus krs_raycast(KrsFrame *frame, const double (*origins)[3], const double (*directions)[3],
                      size_t count, double farthest, double tolerance, KrsHit *hits);

#ifdef __cplusplus
}
#endif
#endif
