/*
 * file.c: chooses who reads a file, and compiles what came of it.
 *
 * Nothing is guessed from the contents: the ending of the name says what a file is.  What does not
 * compile is no scene, so it is refused here, in the words of the compiler, with the file's line.
 */
#include "import/file.h"

#include <stdlib.h>
#include <string.h>

#include "import/csg/csg.h"
#include "import/surfer/jsurf.h"
#include "import/pov/pov.h"
#include "import/svg.h"
#include "import/tape.h"
#include "compiler/passes/compile.h"

static const struct {
    const char *ending;
    bool (*import)(Import *import);
} forms[] = {
#define IMPORT_FORM(ending, import) {ending, import},
#include "import/forms.def"
};
enum { FORMS = sizeof forms / sizeof *forms, MAX_LEFT_OUT = 200 };

static int find_form(const char *path)
{
    const char *ending = strrchr(path, '.');
    for (int i = 0; ending && i < FORMS; i++)
        if (strcmp(ending, forms[i].ending) == 0)
            return i;
    return -1;
}

const char *import_endings(void)
{
#define IMPORT_FORM(ending, import) " " ending
    static const char list[] =
#include "import/forms.def"
        ;
    return list + 1;
}

bool import_knows(const char *path) { return find_form(path) >= 0; }

typedef struct FirstError {
    Import  *import;
    unsigned line; /* of the file */
    bool     found, no_polynomial;
} FirstError;

static const char *blame_at(const FirstError *first)
{
    for (size_t i = 0; i < first->import->blames.count; i++)
        if (first->import->blames.items[i].line == first->line)
            return first->import->blames.items[i].words;
    return NULL;
}

/* Notes what a drawing has and shapes do not, each kind once: "drawing.svg:3: clips and masks". */
static void note_left_out(Import *import, const char *text)
{
    static const char note[] = "= note: ";
    while ((text = strstr(text, note))) {
        size_t length = strcspn(text, "\n");
        for (size_t i = sizeof note - 1; i + 1 < length; i++) {
            size_t digits = text[i] == ':' ? strspn(text + i + 1, "0123456789") : 0;
            size_t words  = i + 1 + digits + 2;
            if (digits > 0 && words < length && strncmp(text + words - 2, ": ", 2) == 0) {
                import_note(import, (unsigned)strtoul(text + i + 1, NULL, 10), "left out: %.*s",
                            (int)(length - words), text + words);
                break;
            }
        }
        text += length;
    }
}

static void note_error(void *user, const KrsDiagnostic *diagnostic)
{
    FirstError *first = user;
    if (strcmp(diagnostic->code, "W0311") == 0)
        note_left_out(first->import, diagnostic->text);
    if (!diagnostic->error || first->found)
        return;
    first->found         = true;
    first->no_polynomial = strcmp(diagnostic->code, "E0410") == 0;
    if (first->no_polynomial && !first->import->as_field)
        return; /* a field may do */
    first->line       = import_origin(first->import, diagnostic->line);
    const char *blame = strcmp(diagnostic->code, "E0402") == 0 ? blame_at(first) : NULL;
    if (blame) {
        import_refuse(first->import, first->line, "%s: a field needs a bound of its slope (%s)",
                      blame, diagnostic->code);
        return;
    }
    import_refuse(first->import, first->line, "what this becomes is no scene: %s (%s)",
                  diagnostic->message, diagnostic->code);
}

static KrsStatus translate(Import *import, FirstError *first)
{
    *first              = (FirstError){.import = import};
    import->scene       = (Text){.arena = import->arena};
    import->marks.count = import->notes.count = import->blames.count = 0;
    if (!forms[find_form(import->path)].import(import))
        return KRS_BAD_SCENE;
    KrsOptions options = import_options(import);
    options.diagnostic = note_error;
    options.user       = first;
    /* Files that it names are sought from where it will stand. */
    const char *name = import->output ? import->output : "scene.krs";
    return krs_check_text(import->scene.bytes, import->scene.length, name, &options);
}

KrsStatus import_file(Import *import)
{
    FirstError first;
    import->refusal  = (Text){.arena = import->arena};
    KrsStatus status = translate(import, &first);
    if (status == KRS_BAD_SCENE && first.no_polynomial) {
        import->as_field = true;
        status           = translate(import, &first);
    }
    /* Leaves out what does not compile, one part after the other. */
    for (int i = 0; i < MAX_LEFT_OUT && status == KRS_BAD_SCENE && first.found; i++) {
        if (import_was_left_out(import, first.line) || !import_leaves_out(import, first.line))
            break;
        array_push(import->arena, &import->no_scene, first.line);
        status = translate(import, &first);
    }
    return status;
}
