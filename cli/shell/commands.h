/*
 * commands.h: one function per subcommand, each in the file of its name, and what they share.
 */
#ifndef KRS_COMMANDS_H
#define KRS_COMMANDS_H

#include "cli/options/options.h"
#include "compiler/base/text.h"
#include "compiler/passes/compile.h"
#include "krs/vulkan.h"

#define COMMAND(id, name, function, arguments, files, summary, examples) \
    KrsStatus function(Options *options);
#include "cli/options/commands.def"
#undef COMMAND

/* The commit that the program was built from, written by the build; empty without git. */
extern const char commit[];

/* scene.c */

/* Compiles a scene file, its diagnostics to standard error.  On KRS_OK the caller owns *scene,
   else it is NULL and the user knows why. */
KrsStatus scene_open(const Options *options, const char *path, KrsScene **scene);
/* Returns KRS_OK, or KRS_IO_ERROR with a message: the file is missing, a folder, or cannot be
   read. */
KrsStatus scene_readable(const Options *options, const char *path);
/* Returns KRS_OK, or reports wrong usage: `output` is the file that is read, by whatever name. */
KrsStatus check_scene_not_overwritten(const Options *options, const char *output);
/* Does the same, and returns KRS_IO_ERROR with words if the output cannot be written. */
KrsStatus check_output(const Options *options, const char *output);

/* Prints diagnostics as they come, and counts them. */
typedef struct DiagnosticSink {
    const Options *options;
    size_t         errors, warnings; /* printed so far */
} DiagnosticSink;

/* Returns the options for compiling that scene; `sink` must outlive the call. */
KrsOptions scene_options(DiagnosticSink *sink, const char *path);
/* Returns the text of a scene that is standard input; NULL: it is the file. */
const char *scene_input(const Options *options, const char *path);
/* Compiles the one or the other. */
KrsStatus scene_compile(const Options *options, const char *path, const KrsOptions *with,
                        KrsScene **scene);
/* Returns the folder that the scene may read from; NULL: any. */
const char *scene_root(const Options *options, const char *path);
/* Notes that the scene of that file is compiled from here on. */
void scene_enter_compile(const char *path);
/* Prints "2 errors, 1 warning", unless there were none. */
void scene_print_counts(const DiagnosticSink *sink);

/* Returns KRS_OK, or KRS_BAD_SCENE with a message: the scene is too large for shaders, which
   somebody needs. */
KrsStatus scene_check_shaders(const Options *options, const KrsScene *scene);
/* Says why a call with that renderer failed. */
void say_renderer(const Options *options, const KrsScene *scene, const KrsRenderer *renderer,
                  KrsStatus status);

/* Makes a frame with --set, --zone and --time; KRS_BAD_ARGUMENT and words when a setting does not
   fit. */
KrsStatus scene_state(const Options *options, const KrsScene *scene, KrsState **state);
/* Finds the number of the camera that --camera names, or of the first; KRS_BAD_ARGUMENT and words:
   there is none. */
KrsStatus scene_camera(const Options *options, const KrsScene *scene, size_t *camera);
/* Tells whether this is the first component of its name: that one --component takes, and it tells the name
   once. */
bool scene_is_first_of_name(const KrsScene *scene, size_t index);
/* Finds the number, from 1, of the component that --component names, or leaves it; KRS_BAD_ARGUMENT and
   words: there is none. */
KrsStatus scene_component(const Options *options, const KrsScene *scene, size_t *number);
/* Sets the time, and reports if the frame cannot have it. */
KrsStatus scene_set_time(const Options *options, KrsState *state, double time);
/* Returns the name of a scene: that of "a/ring.krs" is "ring". */
const char *scene_name(Arena *arena, const char *path);
/* Returns the name of what `krs denoise` writes without -o: of "a/ring.exr" it is "ring-denoised.exr". */
const char *denoised_name(const Options *options);
/* Says what a status means after a call of the library that has no words of its own. */
KrsStatus say_status(KrsStatus status, const char *path);

/* specialize.c, for --specialize auto: compiles the scene again with its numbers in the parameter
   block if that is better for what is to be rendered, which has so many samples in all.  NULL: its
   literals are. */
KrsScene *specialize_edited(const Options *options, const KrsScene *literals, double samples);

/* pack.c: writes a scene and all that it reads, or the pack that it is in already, as a pack. */
KrsStatus pack_scene(const Options *options, const char *path, const char *output);

/* devices.c */

/* Returns the folder in which compiled shaders are kept; NULL: there is none. */
const char *cache_folder(const Options *options);
/* Returns what krs_renderer_new is given, as the options ask for it. */
KrsRendererOptions renderer_options(const Options *options);
/* Opens the device that --device asks for.  On KRS_OK the caller owns *renderer,
   else it is NULL and the user knows why. */
KrsStatus open_renderer(const Options *options, KrsRenderer **renderer);
/* These do the same in two steps, for pictures: between them a scene is compiled, whose mistakes
   the user is to know first.  The second step gets the status of the first. */
KrsStatus open_renderer_early(const Options *options, KrsRenderer **renderer);
KrsStatus opened_renderer(KrsStatus status, KrsRenderer **renderer);

#endif
