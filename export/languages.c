/*
 * languages.c: the text of a scene in the language of a target.
 */
#include "export/parts.h"

#include <stdlib.h>
#include <string.h>

/* ---- texts that are cut ---- */

/* Cuts the declaration of the block of parameters out of a text: the target declares it. */
static void cut_block(char *text)
{
    char *from = strstr(text, "layout(std140"), *end = from ? strchr(from, '\n') : NULL;
    if (end)
        memmove(from, end + 1, strlen(end + 1) + 1);
}

/* Cuts comments and indents. */
static void cut_comments(char *text)
{
    char *to = text;
    for (const char *line = text; *line;) {
        const char  *next = line + strcspn(line, "\n"), *word = line + strspn(line, " ");
        const char  *comment = strstr(word, "//");
        const size_t length  = comment && comment < next ? (size_t)(comment - word)
                                                         : (size_t)(next - word);
        const bool   ends    = *next == '\n';
        memmove(to, word, length);
        to += length;
        if (length > 0 && ends)
            *to++ = '\n';
        line = next + ends;
    }
    *to = '\0';
}

static void cut(char *text)
{
    cut_block(text);
    cut_comments(text);
}

/* ---- texts that are made of others ---- */

/* Adds a text without sets, which Vulkan wants and OpenGL does not know: a macro stands for them. */
static void add_with_sets(Text *to, const char *text)
{
    static const char set[] = "set = 0, ";
    for (const char *at; (at = strstr(text, set)); text = at + sizeof set - 1) {
        text_add_bytes(to, text, (size_t)(at - text));
        text_add(to, "KRS_SET ");
    }
    text_add(to, text);
}

/* Adds a text with krs_parameter, which spirv-cross calls "_17_krs_parameter" in a block without a
   name. */
static void add_named(Text *to, const char *text, size_t length)
{
    static const char name[] = "krs_parameter";
    const char       *end    = text + length;
    for (const char *at; (at = strstr(text, name)) && at < end; text = at) {
        const char *start = at - 1;
        while (start > text && start[-1] >= '0' && start[-1] <= '9')
            start--;
        const bool numbered = at - start > 1 && start > text && at[-1] == '_' && start[-1] == '_';
        text_add_bytes(to, text, (size_t)((numbered ? start - 1 : at) - text));
        text_add(to, name);
        at += sizeof name - 1;
    }
    text_add_bytes(to, text, (size_t)(end - text));
}

/* Adds a text whose entry point is left out where functions alone are included. */
static void add_guarded(Text *to, const char *text)
{
    const char *entry = strstr(text, "\nvoid comp_main()");
    add_named(to, text, entry ? (size_t)(entry + 1 - text) : strlen(text));
    if (entry)
        text_format(to, "#ifdef KRS_KERNEL\n%s#endif\n", entry + 1);
}

static KrsStatus make_glsl(const Export *export, Text *to, Text *why)
{
    (void)why;
    add_with_sets(to, export->text);
    return KRS_OK;
}

static const char *const hlsl_options[] = {"--hlsl", "--shader-model", "50", NULL};

static KrsStatus make_hlsl(const Export *export, Text *to, Text *why)
{
    Text            whole  = {.arena = to->arena};
    const KrsStatus status = cross_compile(export->text, hlsl_options, &whole, why);
    if (status == KRS_OK)
        add_guarded(to, whole.bytes);
    return status;
}

/* Returns where an item of HLSL ends, behind its last line: a struct, a function, or a line. */
static const char *end_of_hlsl(const char *from)
{
    const char *line  = strchr(from, '\n'),
               *close = line && line[1] == '{' ? strstr(from, "\n}") : line;
    const char *end   = close && close != line ? strchr(close + 1, '\n') : close;
    return end ? end + 1 : from + strlen(from);
}

/* Returns the text without an entry point and what that alone needs. */
static const char *without_entry(const Text *whole)
{
    static const char group[] = "static const uint3 gl_WorkGroupSize";
    char *entry = strstr(whole->bytes, "\nvoid comp_main()"), *size = strstr(whole->bytes, group);
    if (entry)
        entry[1] = '\0';
    if (size)
        memmove(size, end_of_hlsl(size), strlen(end_of_hlsl(size)) + 1);
    return whole->bytes;
}

/* Adds HLSL whose textures are at no place of their own, and whose samplers have names as Unity wants them. */
static void add_unbound(Text *to, const char *text)
{
    static const char bound[] = " : register(", sampler[] = "_krs_baked_sampler";
    for (const char *from = text; *from;) {
        if (begins(from, bound))
            from = strchr(from, ')') + 1;
        else if (begins(from, sampler)) {
            text_add(to, "samplerkrs_baked");
            from += sizeof sampler - 1;
        } else
            text_add_bytes(to, from++, 1);
    }
}

static KrsStatus make_hlsl_part(const Export *export, Text *to, Text *why)
{
    Text            whole  = {.arena = to->arena};
    const KrsStatus status = cross_compile(export->text, hlsl_options, &whole, why);
    if (status == KRS_OK)
        add_unbound(to, without_entry(&whole));
    return status;
}

/* Adds HLSL in which globals and functions are members of a struct; constants and structs stand before it. */
static KrsStatus make_hlsl_struct(const Export *export, Text *to, Text *why)
{
    static const char fixed[] = "static const ", global[] = "static ";
    Text              whole = {.arena = to->arena}, members = whole;
    const KrsStatus   status = make_hlsl_part(export, &whole, why);
    if (status != KRS_OK)
        return status;
    for (const char *from = whole.bytes, *end; *from; from = end) {
        end              = end_of_hlsl(from);
        const bool outer = begins(from, fixed) || begins(from, "struct ");
        const bool own   = !outer && begins(from, global);
        text_add_bytes(outer ? to : &members, from + (own ? sizeof global - 1 : 0),
                       (size_t)(end - from) - (own ? sizeof global - 1 : 0));
    }
    text_format(to, "struct Krs\n{\n%s};\n", members.bytes);
    return KRS_OK;
}

static KrsStatus make_msl(const Export *export, Text *to, Text *why)
{
    static const char *const options[] = {"--msl",
                                          "--msl-version",
                                          "20100",
                                          "--msl-texture-buffer-native",
                                          "--msl-decoration-binding",
                                          NULL};
    return cross_compile(export->text, options, to, why);
}

static KrsStatus make_gdshader(const Export *export, Text *to, Text *why)
{
    (void)why;
    Text prepared = {.arena = to->arena};
    set_godot_parameters(&prepared, export);
    add_without_globals(to, export->text, exported_slots(export), "", prepared.bytes);
    return KRS_OK;
}

static KrsStatus make_osl(const Export *export, Text *to, Text *why)
{
    (void)why;
    Text whole = {.arena = to->arena}, given = whole, prepared = whole;
    add_osl_given(&given, export);
    set_osl_parameters(&prepared, export);
    add_without_globals(&whole, export->text, exported_slots(export), given.bytes, prepared.bytes);
    add_osl(to, whole.bytes);
    return KRS_OK;
}

/* ---- languages ---- */

static const struct {
    KrsTarget printed; /* what the library prints */
    bool      lod;     /* with krs_distance_lod */
    void (*cut)(char *text);
    KrsStatus (*make)(const Export *export, Text *to, Text *why); /* NULL: it stays as it is */
} languages[] = {
    [EXPORT_IN_SHORT_ESSL]  = {KRS_TARGET_ESSL, false, cut, NULL},
    [EXPORT_IN_GLSL]        = {KRS_TARGET_GLSL, true, NULL, make_glsl},
    [EXPORT_IN_ESSL]        = {KRS_TARGET_ESSL, true, NULL, NULL},
    [EXPORT_IN_WGSL]        = {KRS_TARGET_WGSL, true, NULL, NULL},
    [EXPORT_IN_HLSL]        = {KRS_TARGET_GLSL, true, NULL, make_hlsl},
    [EXPORT_IN_MSL]         = {KRS_TARGET_GLSL, true, NULL, make_msl},
    [EXPORT_IN_HLSL_PART]   = {KRS_TARGET_GLSL, true, cut_block, make_hlsl_part},
    [EXPORT_IN_HLSL_STRUCT] = {KRS_TARGET_GLSL, true, cut_block, make_hlsl_struct},
    [EXPORT_IN_GDSHADER]    = {KRS_TARGET_ESSL, true, cut_block, make_gdshader},
    [EXPORT_IN_OSL]         = {KRS_TARGET_ESSL, false, cut_block, make_osl},
};

/* Fills a template that another language is made of, in GLSL. */
static const char *fill_in_glsl(const Export *export, Arena *arena, const char *template)
{
    Text         text   = {.arena = arena};
    ExportTarget target = *export->target;
    Export       own    = *export;
    target.words        = "vec#";
    own.target          = &target;
    export_fill(&text, &own, template);
    return text.bytes;
}

KrsStatus find_scene_text(Export *export, Arena *arena, Text *why)
{
    const ExportLanguage language = export->target->language;
    const KrsTextOptions how      = {.no_early_outs = !languages[language].lod};
    char                *printed;
    Text                 made = {.arena = arena};
    KrsStatus            status;
    if (export->baked)
        export->text = fill_in_glsl(export, arena, "baked.glsl");
    else if ((status = krs_text(export->scene, languages[language].printed, &how, &printed)) ==
             KRS_OK) {
        if (languages[language].cut)
            languages[language].cut(printed);
        export->text = arena_copy_text(arena, printed, strlen(printed));
        free(printed);
    } else
        return status;
    if (export->target->source)
        export->text = fill_in_glsl(export, arena, export->target->source);
    if (!languages[language].make)
        return KRS_OK;
    status       = languages[language].make(export, &made, why);
    export->text = made.bytes;
    return status;
}

void add_march(Text *to, const Export *export)
{
    text_add(to, languages[export->target->language].lod ? "krs_distance_lod(p, footprint)"
                                                         : "krs_distance(p)");
}
