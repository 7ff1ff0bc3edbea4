/*
 * letters.c: draws texts by FreeType and HarfBuzz.
 */
#include "compiler/outline/letters.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include <hb.h>
#include <stdlib.h>
#include <string.h>

/* ---- glyphs ---- */

/* One text that is drawn. */
typedef struct Drawing {
    Path                *path;
    const Lettering     *lettering;
    struct FT_MemoryRec_ memory;
    bool                 scarce; /* FreeType could not allocate something */
    FT_Library           library;
    FT_Face              face;
    hb_font_t           *shaper;
    hb_buffer_t         *line;
    double               unit;      /* of the font's coordinates */
    double               origin[2]; /* of the glyph at hand */
    uint32_t             missing;
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

/* The libraries say that there is no memory by what they return. */
static void require(const Drawing *drawing, bool enough_memory)
{
    if (!enough_memory)
        arena_exhausted(drawing->path->arena);
}

static void draw_line(Drawing *drawing, const char *line, size_t length, double baseline)
{
    static const double shares[] = {[ALIGN_LEFT] = 0, [ALIGN_CENTER] = 0.5, [ALIGN_RIGHT] = 1};
    hb_buffer_t        *buffer   = drawing->line;
    unsigned            count    = 0;
    hb_buffer_clear_contents(buffer);
    hb_buffer_add_utf8(buffer, line, (int)length, 0, (int)length);
    hb_buffer_guess_segment_properties(buffer);
    require(drawing, hb_shape_full(drawing->shaper, buffer, NULL, 0, NULL) &&
                         hb_buffer_allocation_successful(buffer));
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
    return FT_New_Memory_Face(drawing->library, font->bytes, (FT_Long)font->length, font->face,
                              &drawing->face) == 0 &&
           FT_IS_SCALABLE(drawing->face) && drawing->face->units_per_EM > 0 &&
           FT_Set_Pixel_Sizes(drawing->face, 0, drawing->face->units_per_EM) == 0;
}

static void draw_text(Drawing *drawing, const Font *font, const char *text)
{
    const int  em   = drawing->face->units_per_EM;
    hb_blob_t *blob = hb_blob_create((const char *)font->bytes, (unsigned)font->length,
                                     HB_MEMORY_MODE_READONLY, NULL, NULL);
    hb_face_t *face = hb_face_create(blob, (unsigned)font->face & 0xFFFF);
    drawing->shaper = hb_font_create(face);
    drawing->unit   = drawing->lettering->size / em;
    hb_blob_destroy(blob); /* The face and the shaper hold what they need. */
    hb_face_destroy(face);
    require(drawing, blob != hb_blob_get_empty() && face != hb_face_get_empty() &&
                         drawing->shaper != hb_font_get_empty());
    hb_font_set_scale(drawing->shaper, em, em);
    drawing->line = hb_buffer_create();
    draw_lines(drawing, text);
}

/* FreeType goes on without what it has no memory for, such as a reader of fonts, so its memory comes from here. */
static void *take(FT_Memory memory, long size)
{
    Drawing *drawing = memory->user;
    void    *block   = malloc((size_t)size);
    drawing->scarce |= !block;
    return block;
}

static void give(FT_Memory memory, void *block)
{
    (void)memory;
    free(block);
}

static void *resize(FT_Memory memory, long before, long size, void *block)
{
    Drawing *drawing = memory->user;
    void    *moved   = realloc(block, (size_t)size);
    (void)before;
    drawing->scarce |= !moved;
    return moved;
}

/* Returns false where the file is no font with outlines. */
static bool draw(Drawing *drawing, const Font *font, const char *text)
{
    require(drawing, FT_New_Library(&drawing->memory, &drawing->library) == 0);
    FT_Add_Default_Modules(drawing->library);
    bool is_font = open_face(drawing, font);
    require(drawing, !drawing->scarce);
    if (is_font)
        draw_text(drawing, font, text);
    require(drawing, !drawing->scarce);
    return is_font;
}

/* Lets memory that runs out unwind to here, and says whether it did, so that the libraries' memory is freed. */
static bool draw_guarded(Drawing *drawing, const Font *font, const char *text, bool *is_font)
{
    Memory  *memory = drawing->path->arena->memory;
    jmp_buf *outer  = memory->exhausted;
    jmp_buf  unwind;
    memory->exhausted = &unwind;
    bool enough       = setjmp(unwind) == 0;
    if (enough)
        *is_font = draw(drawing, font, text);
    memory->exhausted = outer;
    return enough;
}

bool letters_draw(Path *path, const Font *font, const char *text, const Lettering *lettering,
                  uint32_t *missing)
{
    Drawing drawing = {
        .path = path, .lettering = lettering, .memory = {&drawing, take, give, resize}};
    bool is_font = false;
    if (font->length > UINT32_MAX / 2)
        return false;
    bool enough = draw_guarded(&drawing, font, text, &is_font);
    hb_buffer_destroy(drawing.line);
    hb_font_destroy(drawing.shaper);
    FT_Done_Library(drawing.library); /* with its faces */
    if (!enough)
        arena_exhausted(path->arena);
    *missing = drawing.missing;
    return is_font;
}
