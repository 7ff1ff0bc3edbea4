/*
 * shader_text.c: the text of a shader: its file with all that it includes, and the scene's text in
 * the place of scene.glsl.
 */
#include "runtime/device/shader.h"

#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/passes/compile.h"

static const char *find_in(const EmbeddedFile *file, const char *name, size_t length)
{
    for (; file->name; file++)
        if (strlen(file->name) == length && strncmp(file->name, name, length) == 0)
            return file->text;
    return NULL;
}

static const char *find_file(const char *name, size_t length)
{
    const char *text = find_in(shader_files, name, length);
    return text ? text : find_in(helper_files, name, length);
}

/* A shader's text as it grows. */
typedef struct IncludeExpansion {
    const ShaderSource *source;
    const char         *scene; /* its text */
    char               *out;   /* NULL: it is only counted */
    size_t              length;
} IncludeExpansion;

static void append(IncludeExpansion *to, const char *bytes, size_t count)
{
    if (to->out)
        memcpy(to->out + to->length, bytes, count);
    to->length += count;
}

/* Tells whether surfaces that the host has found are in the place of the scene. */
static bool has_surfaces(const ShaderSource *source)
{
    return !source->scene && source->defines && strstr(source->defines, "#define SURFACES\n");
}

/* Appends a file, with those that it includes in place of the lines that say so; false: one is
   missing. */
static bool append_file(IncludeExpansion *to, const char *name, size_t name_length)
{
    static const char include[] = "#include \"";
    bool is_scene    = strncmp(name, "scene.glsl", name_length) == 0 && !has_surfaces(to->source);
    const char *text = is_scene ? to->scene : find_file(name, name_length);
    if (is_scene && text)
        append(to, text, strlen(text));
    for (; !is_scene && text && *text; text += strcspn(text, "\n"), text += *text == '\n') {
        const char *file = text + sizeof include - 1;
        if (strncmp(text, include, sizeof include - 1) != 0)
            append(to, text, strcspn(text, "\n") + (strchr(text, '\n') != NULL));
        else if (!append_file(to, file, strcspn(file, "\"")))
            return false;
        if (to->source->defines && strncmp(text, "#version", 8) == 0) /* nothing may be before it */
            append(to, to->source->defines, strlen(to->source->defines));
    }
    return text != NULL;
}

/* Returns the end of the comment that begins at `text`, at the line's end or behind the closing
   mark; NULL where none begins.  GLSL has no strings, in which such a mark would mean something
   else. */
static const char *comment_end(const char *text)
{
    if (text[0] != '/' || (text[1] != '/' && text[1] != '*'))
        return NULL;
    if (text[1] == '/')
        return text + strcspn(text, "\n");
    const char *end = strstr(text + 2, "*/");
    return end ? end + 2 : text + strlen(text);
}

/* Takes out comments, blanks at the ends of lines, and lines with nothing else: what no compiler
   looks at.  A comment within a line leaves the blank that it stands for. */
void shader_strip(char *text)
{
    char *to = text, *line = text; /* where the line begins in what has been written */
    for (const char *from = text; *from;) {
        const char *behind = comment_end(from);
        char        next   = behind ? ' ' : *from;
        from               = behind ? behind : from + 1;
        if (next != '\n') {
            *to++ = next;
            continue;
        }
        while (to > line && strchr(" \t\r", to[-1]))
            to--;
        if (to > line)
            *to++ = '\n';
        line = to;
    }
    *to = '\0';
}

/* Returns the text of a shader around that of its scene, or NULL. */
static char *expand(Gpu *gpu, const ShaderSource *source, const char *scene)
{
    IncludeExpansion expansion = {source, scene, NULL, 0};
    if (!append_file(&expansion, source->file, strlen(source->file))) {
        gpu_refuse(gpu, KRS_INTERNAL, "the shader `%s`, or a file that it includes, is missing",
                   source->file);
        return NULL;
    }
    expansion.out    = gpu_alloc(gpu, expansion.length + 1, 1, "put a shader together");
    expansion.length = 0;
    if (expansion.out) { /* zeroed memory: the text ends */
        append_file(&expansion, source->file, strlen(source->file));
        shader_strip(expansion.out);
    }
    return expansion.out;
}

char *shader_text(Gpu *gpu, const ShaderSource *source)
{
    const ShaderScene *s = source->scene;
    if (!s)
        return expand(gpu, source, NULL);
    char *scene = krs_scene_text(s->scene, &s->variant, s->wanted, s->wanted_count,
                                 &gpu->allocator);
    if (!scene) {
        gpu_refuse(gpu, KRS_OUT_OF_MEMORY,
                   "cannot print the scene for the shader `%s`: out of memory", source->file);
        return NULL;
    }
    char *text = expand(gpu, source, scene);
    gpu_release(gpu, scene);
    return text;
}
