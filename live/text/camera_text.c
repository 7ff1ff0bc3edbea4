/*
 * camera_text.c: cameras as text of the language.
 */
#include "live/text/camera_text.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/text/text_file.h"

/* ---- properties ---- */

typedef enum Property {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) PROPERTY_##name,
#define KRS_CAMERA_FIXED(name, type, part, counts)          PROPERTY_##name,
#include "krs/camera.def"
    PROPERTIES
} Property;

static const char *const names[PROPERTIES] = {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) #name,
#define KRS_CAMERA_FIXED(name, type, part, counts)          #name,
#include "krs/camera.def"
};

/* Prints numbers, in which zero has no sign. */
static void print_numbers(FILE *out, const double *v, int count)
{
    for (int i = 0; i < count; i++)
        fprintf(out, "%s%.6g", i == 0 ? "[" : ", ", v[i] + 0.0);
    fprintf(out, "]");
}

/* Each of these prints a member of one kind and type of camera.def. */
static void print_place(FILE *out, const double *v) { print_numbers(out, v, 3); }
static void print_axis(FILE *out, const double *v) { print_numbers(out, v, 3); }
static void print_pair(FILE *out, const double *v) { print_numbers(out, v, 2); }
static void print_angle(FILE *out, const double *v) { fprintf(out, "%.6gdeg", *v * 180 / M_PI); }
static void print_number(FILE *out, const double *v) { fprintf(out, "%.6g", *v); }
static void print_focus(FILE *out, const double *v) { print_number(out, v); }
static void print_uint32_t(FILE *out, uint32_t v) { fprintf(out, "%u", v); }
static void print_KrsProjection(FILE *out, KrsProjection v)
{
    static const char *const words[] = {
#define KRS_PROJECTION(id, name) #name,
#include "krs/camera.def"
    };
    fprintf(out, "\"%s\"", words[v]);
}

static void print_value(FILE *out, Property property, const KrsCamera *camera)
{
    switch (property) {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    case PROPERTY_##name:                                   \
        print_##kind(out, (const double *)&camera->name);   \
        break;
#define KRS_CAMERA_FIXED(name, type, part, counts) \
    case PROPERTY_##name:                          \
        print_##type(out, camera->name);           \
        break;
#include "krs/camera.def"
    case PROPERTIES: break;
    }
}

/* Tells whether a block without it would be another camera. */
static bool is_needed(Property property, const KrsCamera *camera)
{
    const bool needed[PROPERTIES] = {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) counts,
#define KRS_CAMERA_FIXED(name, type, part, counts)          counts,
#include "krs/camera.def"
    };
    return needed[property];
}

/* Returns the value as text, which the caller frees; NULL: without memory. */
static char *value_text(Property property, const KrsCamera *camera)
{
    char  *text   = NULL;
    size_t length = 0;
    FILE  *out    = open_memstream(&text, &length);
    if (!out)
        return NULL;
    print_value(out, property, camera);
    return fclose(out) == 0 ? text : NULL;
}

char *camera_text(const KrsCamera *camera)
{
    char       *text   = NULL;
    const char *before = "camera { ";
    size_t      length = 0;
    FILE       *out    = open_memstream(&text, &length);
    if (!out)
        return NULL;
    for (Property i = 0; i < PROPERTIES; i++)
        if (is_needed(i, camera)) {
            fprintf(out, "%s%s: ", before, names[i]);
            print_value(out, i, camera);
            before = ", ";
        }
    fprintf(out, " }\n");
    return fclose(out) == 0 ? text : NULL;
}

/* ---- where they stand in a block ---- */

/* Skips blanks and comments. */
static const char *skip_blanks(const char *at)
{
    for (;;) {
        while (isspace((unsigned char)*at))
            at++;
        if (at[0] == '/' && at[1] == '/') {
            at += strcspn(at, "\n");
        } else if (at[0] == '/' && at[1] == '*') {
            const char *end = strstr(at + 2, "*/");
            at              = end ? end + 2 : at + strlen(at);
        } else {
            return at;
        }
    }
}

static const char *skip_word(const char *at)
{
    while (isalnum((unsigned char)*at) || *at == '_')
        at++;
    return at;
}

/* Skips a text between quotes. */
static const char *skip_string(const char *at)
{
    for (at++; *at && *at != '"'; at++)
        if (at[0] == '\\' && at[1])
            at++;
    return *at ? at + 1 : at;
}

/* Finds where a value ends: before the comma or brace that ends it, and blanks and comments before
   that. */
static const char *end_of_value(const char *at)
{
    const char *end   = at;
    int         depth = 0;
    for (at = skip_blanks(at); *at && (depth > 0 || (*at != ',' && *at != '}'));
         at = skip_blanks(at)) {
        depth += strchr("([{", *at) ? 1 : strchr(")]}", *at) ? -1 : 0;
        at  = *at == '"' ? skip_string(at) : at + 1;
        end = at;
    }
    return end;
}

/* A property of a block, as bytes: from its name, its value, up to its end. */
typedef struct Place {
    size_t start, value, end;
} Place;

/* Looks at the properties of a block one after the other: `at` is where the next may begin.  False:
   there is none. */
static bool next_property(const char *block, size_t *at, Place *place)
{
    const char *start = skip_blanks(block + *at), *end;
    if (*start == ',')
        start = skip_blanks(start + 1);
    end = skip_word(start);
    if (end == start || *skip_blanks(end) != ':')
        return false;
    const char *value = skip_blanks(skip_blanks(end) + 1);
    *place            = (Place){(size_t)(start - block), (size_t)(value - block),
                                (size_t)(end_of_value(value) - block)};
    *at               = place->end;
    return true;
}

/* Finds a property, or with NULL the last one. */
static bool find_property(const char *block, const char *name, Place *place)
{
    const char *brace = strchr(block, '{');
    size_t      at    = brace ? (size_t)(brace - block) + 1 : strlen(block);
    bool        any   = false;
    Place       found;
    while (next_property(block, &at, &found)) {
        const char *word = block + found.start;
        any              = true;
        *place           = found;
        if (name && strncmp(word, name, strlen(name)) == 0 &&
            skip_word(word) == word + strlen(name))
            return true;
    }
    return !name && any;
}

/* ---- edits ---- */

/* Replaces bytes [start, end) of a text, which it frees.  NULL: without memory. */
static char *splice(char *text, size_t start, size_t end, const char *name, const char *value)
{
    char *spliced = NULL;
    if (asprintf(&spliced, "%.*s%s%s%s", (int)start, text, name, value, text + end) < 0)
        spliced = NULL;
    free(text);
    return spliced;
}

static char *add_property(char *block, const char *name, const char *value)
{
    Place last;
    char  label[32];
    if (find_property(block, NULL, &last)) {
        snprintf(label, sizeof label, ", %s: ", name);
        return splice(block, last.end, last.end, label, value);
    }
    const size_t brace = strcspn(block, "{") + 1;
    snprintf(label, sizeof label, " %s: ", name);
    return splice(block, brace, brace, label, value);
}

/* Returns the comma before a property, which has one: it stands behind the value of the property
   before.  Others may stand in comments. */
static size_t comma_before(const char *block, const Place *place)
{
    size_t at = strcspn(block, "{") + 1, comma = at;
    Place  before;
    while (next_property(block, &at, &before) && before.start < place->start)
        comma = (size_t)(skip_blanks(block + before.end) - block);
    return comma;
}

/* Removes a property with the comma behind it, or before it. */
static char *remove_property(char *block, const Place *place)
{
    const char  *behind = skip_blanks(block + place->end);
    const size_t start = place->start, comma = comma_before(block, place);
    if (*behind == ',')
        return splice(block, start, (size_t)(skip_blanks(behind + 1) - block), "", "");
    block = splice(block, start, place->end, "", "");
    return block && block[comma] == ',' ? splice(block, comma, comma + 1, "", "") : block;
}

static char *edit_property(char *block, Property property, const KrsCamera *before,
                           const KrsCamera *camera)
{
    char      *old = value_text(property, before), *value = value_text(property, camera);
    const bool differs = old && value && strcmp(old, value) != 0;
    Place      place;
    const bool is_there = differs && find_property(block, names[property], &place);
    if (differs && !is_there)
        block = is_needed(property, camera) ? add_property(block, names[property], value) : block;
    else if (is_there && (is_needed(property, camera) || property == PROPERTY_up ||
                          property == PROPERTY_projection))
        block = splice(block, place.value, place.end, "", value);
    else if (is_there)
        block = remove_property(block, &place);
    free(old);
    free(value);
    return block;
}

char *camera_text_edit(const char *block, const KrsCamera *before, const KrsCamera *camera)
{
    const size_t length = strlen(block);
    const bool   good = strncmp(block, "camera", 6) == 0 && length > 7 && block[length - 1] == '}';
    char        *edited = good ? strdup(block) : NULL;
    for (Property i = 0; edited && i < PROPERTIES; i++)
        edited = edit_property(edited, i, before, camera);
    return edited;
}

/* ---- files ---- */

/* Replaces bytes [start, end) of a file. */
static KrsStatus write_instead(const char *path, const Bytes *before, size_t start, size_t end,
                               const char *text)
{
    Bytes     after  = {0};
    KrsStatus status = KRS_OUT_OF_MEMORY;
    FILE     *out    = open_memstream(&after.text, &after.length);
    if (out) {
        const bool joined = start > 0 && start == before->length && before->text[start - 1] != '\n';
        fwrite(before->text, 1, start, out);
        fprintf(out, "%s%s", joined ? "\n" : "", text);
        fwrite(before->text + end, 1, before->length - end, out);
        if (fclose(out) == 0)
            status = text_file_write(path, &after) ? KRS_OK : KRS_IO_ERROR;
    }
    free(after.text);
    return status;
}

static KrsStatus change(const KrsLocation *place, const KrsCamera *before, const KrsCamera *camera)
{
    Bytes     bytes = {0};
    char     *block = NULL, *edited = NULL;
    KrsStatus status = text_file_read(place->source, &bytes) ? KRS_BAD_ARGUMENT : KRS_IO_ERROR;
    if (status == KRS_BAD_ARGUMENT && place->start < place->end && place->end <= bytes.length)
        block = strndup(bytes.text + place->start, place->end - place->start);
    if (block)
        edited = camera_text_edit(block, before, camera);
    if (edited)
        status = write_instead(place->source, &bytes, place->start, place->end, edited);
    free(bytes.text);
    free(block);
    free(edited);
    return status;
}

static KrsStatus add(const char *path, const KrsCamera *camera)
{
    Bytes     bytes  = {0};
    char     *block  = camera_text(camera);
    KrsStatus status = !block                          ? KRS_OUT_OF_MEMORY
                       : !text_file_read(path, &bytes) ? KRS_IO_ERROR
                                                       : KRS_OK;
    if (status == KRS_OK)
        status = write_instead(path, &bytes, bytes.length, bytes.length, block);
    free(bytes.text);
    free(block);
    return status;
}

KrsStatus camera_text_write(const KrsScene *scene, size_t index, const KrsCamera *before,
                            const KrsCamera *camera, const char *path)
{
    KrsLocation place;
    if (krs_camera_location(scene, index, &place) != KRS_OK)
        return add(path, camera);
    return change(&place, before, camera);
}
