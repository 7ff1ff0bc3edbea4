/*
 * numbers.c: numbers as shading languages have them.
 */
#include "export/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of single precision has too many digits for some languages. */
#define MAX_FLOAT 3.4e38

void add_float(Text *to, double number)
{
    const float rounded = (float)fmin(fmax(number, -MAX_FLOAT), MAX_FLOAT);
    char        digits[32];
    for (int count = 6; count <= 9; count++) { /* as few as have this number */
        snprintf(digits, sizeof digits, "%.*g", count, (double)rounded);
        if (strtof(digits, NULL) == rounded)
            break;
    }
    text_format(to, "%s%s", digits, strpbrk(digits, ".e") ? "" : ".0");
}

void add_vector(Text *to, const Export *export, const double *numbers, int count)
{
    const char *words = export->target->words, *sign = strchr(words, '#');
    text_add_bytes(to, words, (size_t)(sign - words));
    text_format(to, "%d%s(", count, sign + 1);
    for (int i = 0; i < count; i++) {
        text_add(to, i ? ", " : "");
        add_float(to, numbers[i]);
    }
    text_add(to, ")");
}
