/*
 * number_edit.c: tries one number after the other.
 */
#include "bench/view/number_edit.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/fixture.h"
#include "live/text/text_file.h"

enum { MAX_TRIES = 60 };
/* Some texts take seconds to compile. */
static const double MAX_SECONDS = 30;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Returns the next number with a point, outside of comments: the offset of its last digit, or 0. */
static size_t find_number(const char *text, size_t from)
{
    for (size_t i = from; text[i]; i++) {
        if (text[i] == '/' && text[i + 1] == '/')
            i += strcspn(text + i, "\n");
        if (text[i] == '.' && i > 0 && isdigit((unsigned char)text[i - 1]) &&
            isdigit((unsigned char)text[i + 1])) {
            while (isdigit((unsigned char)text[i + 1]))
                i++;
            return i;
        }
    }
    return 0;
}

static Bytes read_text(const char *path)
{
    Bytes text = {0};
    if (!text_file_read(path, &text))
        give_up(path, "it cannot be read");
    return text;
}

void number_edit_write(NumberEdit *edit)
{
    Bytes      text     = read_text(edit->path);
    const char before   = text.text[edit->at];
    text.text[edit->at] = edit->other;
    edit->other         = before;
    if (!text_file_write(edit->path, &text))
        give_up(edit->path, "it cannot be written");
    free(text.text);
}

/* Tells whether the document is read, and has the shaders that it had. */
static bool changes_values(Document *document)
{
    Version       *before    = document_version(document);
    const unsigned structure = version_structure(before);
    version_release(before);
    if (document_read(document) != KRS_OK)
        return false;
    Version   *version = document_version(document);
    const bool same    = version_structure(version) == structure &&
                      version_changes(version).kind == KRS_CHANGE_VALUES;
    version_release(version);
    return same;
}

/* Edits the number in the file; puts it back, and returns false, where that needs other shaders. */
static bool try_edit(Document *document, NumberEdit *edit, char digit)
{
    edit->other = digit == '9' ? '8' : (char)(digit + 1);
    number_edit_write(edit);
    if (changes_values(document))
        return true;
    number_edit_write(edit);
    if (document_read(document) != KRS_OK)
        give_up(edit->path, "the text does not compile again");
    return false;
}

NumberEdit number_edit_find(Document *document, const char *path, size_t from)
{
    Bytes        text  = read_text(path);
    NumberEdit   edit  = {.path = path, .at = from};
    bool         found = false;
    const double begun = now();
    for (int i = 0; i < MAX_TRIES && !found && now() - begun < MAX_SECONDS; i++) {
        edit.at = find_number(text.text, edit.at + 1);
        if (edit.at == 0)
            break;
        found = try_edit(document, &edit, text.text[edit.at]);
    }
    free(text.text);
    if (!found)
        edit.at = 0;
    return edit;
}
