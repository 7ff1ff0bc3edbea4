/*
 * synonyms.c: looks words up in synonyms.def, and names in the files of the library.
 */
#include "compiler/front/synonyms.h"

#include <ctype.h>
#include <string.h>

#include "compiler/base/embedded.h"

static const Synonym rows[] = {
#define SYNONYM(place, word, owner, from, instead, meaning, example) \
    {SYNONYM_##place, word, owner, from, instead, meaning, example},
#define FORM(...)
#include "compiler/front/synonyms.def"
};
enum { ROW_COUNT = sizeof rows / sizeof *rows };

static const struct {
    const char *written, *meaning, *example;
} forms[] = {
#define SYNONYM(...)
#define FORM(name, written, meaning, example) {written, meaning, example},
#include "compiler/front/synonyms.def"
};

const Synonym *synonym_row(size_t index) { return index < ROW_COUNT ? &rows[index] : NULL; }
const char    *form_written(SynonymForm form) { return forms[form].written; }
const char    *form_example(SynonymForm form) { return forms[form].example; }

const char *form_help(Diags *diags, SynonymForm form)
{
    return diag_text(diags, "%s, as in `%s`", forms[form].meaning, forms[form].example);
}

/* ---- words ---- */

static bool explain(Diags *diags, Diag *diag, const Synonym *row)
{
    if (!row)
        return false;
    if (*row->from && row->place <= SYNONYM_DIRECTIVE)
        diag->label = diag_text(diags, "a word of %s", row->from);
    diag->help        = diag_text(diags, "%s, as in `%s`", row->meaning, row->example);
    diag->replacement = *row->instead ? row->instead : NULL;
    return true;
}

static const Synonym *find_row(SynonymPlace place, const char *word, const char *owner)
{
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (rows[i].place == place && strcmp(rows[i].word, word) == 0 &&
            strcmp(rows[i].owner, owner) == 0)
            return &rows[i];
    return NULL;
}

bool is_synonym(SynonymPlace place, const char *word) { return find_row(place, word, "") != NULL; }

/* Returns the place that is looked at where a word has no row of its own: names may be statements,
   methods of names, and so on. */
static SynonymPlace other_place(SynonymPlace place)
{
    switch (place) {
    case SYNONYM_NAME: return SYNONYM_STATEMENT;
    case SYNONYM_STATEMENT:
    case SYNONYM_METHOD: return SYNONYM_NAME;
    default: return place;
    }
}

bool explain_word(Diags *diags, Diag *diag, SynonymPlace place, const char *word, const char *owner)
{
    const Synonym *row = find_row(place, word, owner);
    if (row || other_place(place) == place)
        return explain(diags, diag, row);
    bool found = explain(diags, diag, find_row(other_place(place), word, owner));
    if (found) /* its place is another one */
        diag->replacement = NULL;
    return found;
}

bool explain_parameter(Diags *diags, Diag *diag, const char *word, const char *owner,
                       const char *const *parameters, size_t count)
{
    if (explain(diags, diag, find_row(SYNONYM_PARAMETER, word, owner)))
        return true;
    const Synonym *row = find_row(SYNONYM_PARAMETER, word, "");
    bool           has = row && *row->instead == '\0';
    for (size_t i = 0; row && i < count; i++)
        has = has || strcmp(parameters[i], row->instead) == 0;
    return has && explain(diags, diag, row);
}

/* ---- the library ---- */

/* Tells whether a line of a text defines the name, at its beginning. */
static bool defines(const EmbeddedFile *file, const char *name)
{
    static const char *const words[] = {"def ", "let ", "shape ", "material "};
    size_t                   length  = strlen(name);
    for (const char *line = file->text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            const char *at = line + strlen(words[i]);
            if (strncmp(line, words[i], strlen(words[i])) == 0 && strncmp(at, name, length) == 0 &&
                !isalnum((unsigned char)at[length]) && at[length] != '_')
                return true;
        }
    }
    return false;
}

bool explain_name(Diags *diags, Diag *diag, const char *name)
{
    const char *found = NULL;
    for (const EmbeddedFile *file = library_files; file->name && name[0] != '_'; file++)
        if (strchr(file->name, '/') && defines(file, name))
            found = file->name;
    if (!found)
        return explain_word(diags, diag, SYNONYM_NAME, name, "");
    diag->label = "defined in a file of the library";
    diag->help  = diag_text(diags, "`use \"%s\";` makes it visible", found);
    return true;
}

/* Returns the part of a path behind its last slash and before its last point. */
static const char *stem(Diags *diags, const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name  = slash ? slash + 1 : path;
    return diag_text(diags, "%.*s", (int)strcspn(name, "."), name);
}

void explain_file(Diags *diags, Diag *diag, const char *path)
{
    enum { MAX_FILES = 32 };
    const char *stems[MAX_FILES], *paths[MAX_FILES], *near;
    size_t      count = 0;
    Text        list  = {.arena = diags->arena};
    for (const EmbeddedFile *file = library_files; file->name && count < MAX_FILES; file++) {
        if (!strchr(file->name, '/'))
            continue;
        text_format(&list, "%s %s", count ? "," : "the library has:", file->name);
        stems[count]   = stem(diags, file->name);
        paths[count++] = file->name;
    }
    near = nearest_name(stem(diags, path), stems, count);
    for (size_t i = 0; near && i < count; i++)
        if (stems[i] == near) {
            diag->help        = "a file of the library has a similar name";
            diag->replacement = diag_text(diags, "\"%s\"", paths[i]);
        }
    if (list.length && (near || strncmp(path, "std/", 4) == 0))
        diag_note(diags, diag, list.bytes);
}
