/*
 * tables.c: tables of parts that are alike, and textures, as bytes and in base64.
 */
#include "export/parts.h"

#include <stdint.h>

static void add_base64(Text *to, const unsigned char *bytes, size_t length)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < length; i += 3) {
        uint32_t three = (uint32_t)bytes[i] << 16;
        char     four[4];
        three |= i + 1 < length ? (uint32_t)bytes[i + 1] << 8 : 0;
        three |= i + 2 < length ? (uint32_t)bytes[i + 2] : 0;
        for (int k = 0; k < 4; k++)
            four[k] = i + (size_t)k <= length ? letters[three >> (18 - 6 * k) & 63] : '=';
        text_add_bytes(to, four, sizeof four);
    }
}

bool has_tables(const Export *export)
{
    return !export->baked && krs_table_cells(export->scene) > 0;
}

const unsigned char *table_bytes(const Export *export, bool rows, size_t *length, Arena *arena)
{
    const size_t rows_size  = krs_table_rows(export->scene) * sizeof(float[4]),
                 cells_size = krs_table_cells(export->scene) * sizeof(uint32_t[2]);
    unsigned char *bytes    = arena_alloc(arena, 1, rows_size + cells_size);
    krs_state_tables(export->state, (void *)bytes, (void *)(bytes + rows_size));
    *length = rows ? rows_size : cells_size;
    return rows ? bytes : bytes + rows_size;
}

static void add_table(Text *to, const Export *export, bool rows)
{
    size_t length;
    if (!has_tables(export))
        return;
    const unsigned char *bytes = table_bytes(export, rows, &length, to->arena);
    add_base64(to, bytes, length);
}

void add_rows(Text *to, const Export *export) { add_table(to, export, true); }
void add_cells(Text *to, const Export *export) { add_table(to, export, false); }

void add_baked_text(Text *to, const Export *export)
{
    size_t length;
    if (export->baked) {
        const unsigned char *bytes = baked_bytes(export, &length);
        add_base64(to, bytes, length);
    }
}
