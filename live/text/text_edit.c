/*
 * text_edit.c: from the viewer back to the text of the scene.
 */
#include "live/text/text_edit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "live/text/text_file.h"

/* ---- values ---- */

/* Prints a hexadecimal colour, if there is one that is this. */
static bool print_color(FILE *out, const double *value)
{
    unsigned bytes[3];
    for (int i = 0; i < 3; i++) {
        if (!(value[i] >= 0 && value[i] <= 1))
            return false;
        bytes[i] = (unsigned)lround(255 * srgb_of_linear(value[i]));
    }
    fprintf(out, "#%02x%02x%02x", bytes[0], bytes[1], bytes[2]);
    return true;
}

/* Prints a number.  Six digits do, but for values at the end of a range: rounded, they would be
   outside. */
static void print_number(FILE *out, const KrsParameter *parameter, uint32_t i, double value)
{
    enum { FEWEST_DIGITS = 6, MAX_DIGITS = 17 };
    char text[40];
    for (int digits = FEWEST_DIGITS; digits <= MAX_DIGITS; digits++) {
        snprintf(text, sizeof text, "%.*g", digits,
                 parameter->degrees ? value / M_PI * 180 : value);
        const double number = strtod(text, NULL);
        const double read   = parameter->degrees ? number / 180 * M_PI : number;
        if (read >= parameter->low[i] && read <= parameter->high[i])
            break;
    }
    fprintf(out, "%s%s", text, parameter->degrees ? "deg" : "");
}

static void print_value(FILE *out, const KrsParameter *parameter, const double *value)
{
    if (parameter->color && print_color(out, value))
        return;
    for (uint32_t i = 0; i < parameter->components; i++) {
        if (parameter->components > 1)
            fprintf(out, "%s", i == 0 ? "[" : ", ");
        print_number(out, parameter, i, value[i]);
    }
    if (parameter->components > 1)
        fprintf(out, "]");
}

/* ---- defaults ---- */

static bool is_default(const KrsParameter *parameter, const double *value)
{
    return memcmp(parameter->value, value, parameter->components * sizeof *value) == 0;
}

/* Tells whether the text still has "NAME =" before these bytes, and `in` or `;` behind them. */
static bool stands_there(const Bytes *bytes, const KrsParameter *parameter)
{
    size_t       before = parameter->start, behind = parameter->end;
    const size_t length = strlen(parameter->name);
    if (behind > bytes->length || before > behind)
        return false;
    while (before > 0 && isspace((unsigned char)bytes->text[before - 1]))
        before--;
    if (before == 0 || bytes->text[--before] != '=')
        return false;
    while (before > 0 && isspace((unsigned char)bytes->text[before - 1]))
        before--;
    while (behind < bytes->length && isspace((unsigned char)bytes->text[behind]))
        behind++;
    return before >= length &&
           memcmp(bytes->text + before - length, parameter->name, length) == 0 &&
           behind < bytes->length &&
           (bytes->text[behind] == ';' || strncmp(bytes->text + behind, "in", 2) == 0);
}

static KrsStatus write_default(const KrsParameter *parameter, const double *value)
{
    Bytes     before = {0}, after = {0};
    KrsStatus status = text_file_read(parameter->source, &before) ? KRS_OK : KRS_IO_ERROR;
    if (status == KRS_OK && !stands_there(&before, parameter))
        status = KRS_BAD_ARGUMENT;
    FILE *out = status == KRS_OK ? open_memstream(&after.text, &after.length) : NULL;
    if (out) {
        fwrite(before.text, 1, parameter->start, out);
        print_value(out, parameter, value);
        fwrite(before.text + parameter->end, 1, before.length - parameter->end, out);
        if (fclose(out) != 0 || !text_file_write(parameter->source, &after))
            status = KRS_IO_ERROR;
    }
    free(before.text);
    free(after.text);
    return status;
}

/* Finds the parameter that stands last before this byte, in whatever file; false: there is none. */
static bool find_last(const KrsScene *scene, uint64_t before, size_t *last)
{
    uint64_t found = 0;
    bool     any   = false;
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        const uint64_t place = ((uint64_t)parameter.start << 24) + i;
        if (place < before && (!any || place > found)) {
            found = place;
            *last = i;
            any   = true;
        }
    }
    return any;
}

/* Writes from the end of the files on, so that places before stay what they are. */
KrsStatus write_defaults(const KrsScene *scene, const double (*values)[4], size_t *written)
{
    uint64_t  before = UINT64_MAX;
    KrsStatus status = KRS_OK;
    size_t    i;
    *written = 0;
    while (status == KRS_OK && find_last(scene, before, &i)) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        before = ((uint64_t)parameter.start << 24) + i;
        if (is_default(&parameter, values[i]))
            continue;
        status = write_default(&parameter, values[i]);
        *written += status == KRS_OK;
    }
    return status;
}
