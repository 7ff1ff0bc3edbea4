/*
 * letters.c: the bridge to FreeType and HarfBuzz.
 */
#include "compiler/outline/letters.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <hb.h>
#include <stdlib.h>
#include <string.h>

/* ---- glyphs ---- */

/* One text that is drawn. */
typedef struct Drawing {
    Path            *path;
    const Lettering *lettering;
    FT_Library       library;
    FT_Face          face;
    hb_font_t       *shaper;
    double           unit;      /* of the font's coordinates */
    double           origin[2]; /* of the glyph at hand */
    uint32_t         missing;
} Drawing;

/* Points are whole numbers to FreeType.  At as many pixels per em as the em has units, a unit is 64 of them;
   they are shifted by a bit, so that what stands halfway between two, as points of TrueType do that
   are not written, is a whole number as well. */
enum { PARTS_OF_UNIT = 64, HALVES = 1 };

static void place(const Drawing *drawing, const FT_Vector *point, double at[2])
{
    const double part = drawing->unit / (PARTS_OF_UNIT << HALVES);
    at[0]             = drawing->origin[0] + part * (double)point->x;
    at[1]             = drawing->origin[1] + part * (double)point->y;
}

static int move_to(const FT_Vector *to, void *user)
{
    const Drawing *drawing = user;
    double         at[2];
    place(drawing, to, at);
    path_move(drawing->path, at);
    return 0;
}

static int line_to(const FT_Vector *to, void *user)
{
    const Drawing *drawing = user;
    double         at[2];
    place(drawing, to, at);
    path_line(drawing->path, at);
    return 0;
}

static int conic_to(const FT_Vector *via, const FT_Vector *to, void *user)
{
    const Drawing *drawing = user;
    double         middle[2], at[2];
    place(drawing, via, middle);
    place(drawing, to, at);
    path_quadratic(drawing->path, middle, at);
    return 0;
}

static int cubic_to(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to,
                    void *user)
{
    const Drawing *drawing = user;
    double         one[2], two[2], at[2];
    place(drawing, first, one);
    place(drawing, second, two);
    place(drawing, to, at);
    path_cubic(drawing->path, one, two, at);
    return 0;
}

static void draw_glyph(Drawing *drawing, uint32_t glyph)
{
    static const FT_Outline_Funcs functions = {move_to, line_to, conic_to, cubic_to, HALVES, 0};
    if (FT_Load_Glyph(drawing->face, glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) == 0 &&
        drawing->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE)
        FT_Outline_Decompose(&drawing->face->glyph->outline, &functions, drawing);
    path_close(drawing->path);
}

/* ---- lines ---- */

static double advance_of(const Drawing *drawing, const hb_glyph_position_t *glyph)
{
    return drawing->unit * glyph->x_advance +
           drawing->lettering->spacing * drawing->lettering->size;
}

static double line_width(const Drawing *drawing, const hb_glyph_position_t *glyphs, unsigned count)
{
    double width = 0;
    for (unsigned i = 0; i < count; i++)
        width += advance_of(drawing, &glyphs[i]);
    return count ? width - drawing->lettering->spacing * drawing->lettering->size : 0;
}

static void note_missing(Drawing *drawing, const char *line, const hb_glyph_info_t *glyph)
{
    uint32_t character = 0xFFFD;
    if (glyph->codepoint != 0 || drawing->missing)
        return;
    text_character(line + glyph->cluster, strlen(line + glyph->cluster), &character);
    drawing->missing = character;
}

static void draw_line(Drawing *drawing, const char *line, size_t length, double baseline)
{
    static const double shares[] = {[ALIGN_LEFT] = 0, [ALIGN_CENTER] = 0.5, [ALIGN_RIGHT] = 1};
    hb_buffer_t        *buffer   = hb_buffer_create();
    unsigned            count    = 0;
    hb_buffer_add_utf8(buffer, line, (int)length, 0, (int)length);
    hb_buffer_guess_segment_properties(buffer);
    hb_shape(drawing->shaper, buffer, NULL, 0);
    const hb_glyph_info_t     *glyphs = hb_buffer_get_glyph_infos(buffer, &count);
    const hb_glyph_position_t *places = hb_buffer_get_glyph_positions(buffer, &count);
    double pen = -shares[drawing->lettering->align] * line_width(drawing, places, count);
    for (unsigned i = 0; i < count; i++) {
        note_missing(drawing, line, &glyphs[i]);
        drawing->origin[0] = pen + drawing->unit * places[i].x_offset;
        drawing->origin[1] = baseline + drawing->unit * places[i].y_offset;
        draw_glyph(drawing, glyphs[i].codepoint);
        pen += advance_of(drawing, &places[i]);
    }
    hb_buffer_destroy(buffer);
}

static void draw_lines(Drawing *drawing, const char *text)
{
    const FT_Face face     = drawing->face;
    double        height   = drawing->lettering->line_height > 0
                                 ? drawing->lettering->line_height * drawing->lettering->size
                                 : drawing->unit * face->height;
    double        baseline = 0;
    for (const char *line = text; line; baseline -= height) {
        const char *end = strchr(line, '\n');
        draw_line(drawing, line, end ? (size_t)(end - line) : strlen(line), baseline);
        line = end ? end + 1 : NULL;
    }
}

/* ---- the whole ---- */

static bool open_face(Drawing *drawing, const Font *font)
{
    if (FT_Init_FreeType(&drawing->library) != 0)
        return false;
    if (FT_New_Memory_Face(drawing->library, font->bytes, (FT_Long)font->length, font->face,
                           &drawing->face) == 0 &&
        FT_IS_SCALABLE(drawing->face) && drawing->face->units_per_EM > 0 &&
        FT_Set_Pixel_Sizes(drawing->face, 0, drawing->face->units_per_EM) == 0)
        return true;
    FT_Done_FreeType(drawing->library); /* with its faces */
    return false;
}

/* What the libraries hold is freed also where memory runs out: so contours are in memory that unwinds
   to here. */
static bool draw_all(Drawing *drawing, const Font *font, const char *text, Memory *memory)
{
    jmp_buf    unwind;
    const int  em   = drawing->face->units_per_EM;
    hb_blob_t *blob = hb_blob_create((const char *)font->bytes, (unsigned)font->length,
                                     HB_MEMORY_MODE_READONLY, NULL, NULL);
    hb_face_t *face = hb_face_create(blob, (unsigned)font->face & 0xFFFF);
    drawing->shaper = hb_font_create(face);
    drawing->unit   = drawing->lettering->size / em;
    hb_font_set_scale(drawing->shaper, em, em);
    memory->exhausted = &unwind;
    bool drawn        = setjmp(unwind) == 0;
    if (drawn)
        draw_lines(drawing, text);
    hb_font_destroy(drawing->shaper);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
    return drawn;
}

bool letters_draw(Path *path, const Font *font, const char *text, const Lettering *lettering,
                  uint32_t *missing)
{
    Memory  memory  = {0};
    Arena   arena   = {.memory = &memory};
    Path    own     = {.arena = &arena, .tolerance = path->tolerance};
    Drawing drawing = {.path = &own, .lettering = lettering};
    if (font->length > UINT32_MAX / 2 || !open_face(&drawing, font))
        return false;
    bool drawn = draw_all(&drawing, font, text, &memory);
    FT_Done_FreeType(drawing.library);
    if (drawn)
        path_take(path, &own);
    arena_free(&arena);
    *missing = drawing.missing;
    return drawn;
}
