/*
 * cells.c: pictures as characters of a terminal, by libchafa, which the build may lack.
 */
#include "live/window/cells.h"

#include <stddef.h>

#ifdef KRS_HAS_CHAFA
#include <chafa.h>
#include <string.h>
#include <unistd.h>

bool cells_exist(void) { return true; }

static ChafaCanvasMode choose_colors(const ChafaTermInfo *info)
{
    return chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_DIRECT)
               ? CHAFA_CANVAS_MODE_TRUECOLOR
           : chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_256)
               ? CHAFA_CANVAS_MODE_INDEXED_240
           : chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_16)
               ? CHAFA_CANVAS_MODE_INDEXED_16
               : CHAFA_CANVAS_MODE_FGBG;
}

/* Terminals that show pixels get pixels. */
static ChafaPixelMode choose_pixels(const ChafaTermInfo *info)
{
    return chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_BEGIN_KITTY_IMMEDIATE_IMAGE_V1)
               ? CHAFA_PIXEL_MODE_KITTY
           : chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_BEGIN_SIXELS) ? CHAFA_PIXEL_MODE_SIXELS
                                                                         : CHAFA_PIXEL_MODE_SYMBOLS;
}

bool cells_have_pixels(void)
{
    ChafaTermInfo *info = chafa_term_db_detect(chafa_term_db_get_default(), environ);
    const bool     have = choose_pixels(info) != CHAFA_PIXEL_MODE_SYMBOLS;
    chafa_term_info_unref(info);
    return have;
}

/* Takes away what was shown before.  Kitty else keeps all pictures, one upon the other. */
static const char *clear_before(const ChafaTermInfo *info)
{
    return choose_pixels(info) == CHAFA_PIXEL_MODE_KITTY ? "\033_Ga=d,d=A\033\\" : "";
}

static ChafaCanvas *make_canvas(const ChafaTermInfo *info, int columns, int rows, int cell_width,
                                int cell_height)
{
    ChafaSymbolMap    *symbols = chafa_symbol_map_new();
    ChafaCanvasConfig *config  = chafa_canvas_config_new();
    chafa_symbol_map_add_by_tags(symbols, CHAFA_SYMBOL_TAG_BLOCK | CHAFA_SYMBOL_TAG_SPACE);
    chafa_canvas_config_set_geometry(config, columns, rows);
    chafa_canvas_config_set_cell_geometry(config, cell_width, cell_height);
    chafa_canvas_config_set_canvas_mode(config, choose_colors(info));
    chafa_canvas_config_set_pixel_mode(config, choose_pixels(info));
    chafa_canvas_config_set_symbol_map(config, symbols);
    ChafaCanvas *canvas = chafa_canvas_new(config);
    chafa_canvas_config_unref(config);
    chafa_symbol_map_unref(symbols);
    return canvas;
}

char *cells_print(const uint8_t *pixels, uint32_t width, uint32_t height, int columns, int rows,
                  int cell_width, int cell_height)
{
    ChafaTermInfo *info   = chafa_term_db_detect(chafa_term_db_get_default(), environ);
    ChafaCanvas   *canvas = make_canvas(info, columns, rows, cell_width, cell_height);
    chafa_canvas_draw_all_pixels(canvas, CHAFA_PIXEL_RGBA8_UNASSOCIATED, pixels, (gint)width,
                                 (gint)height, (gint)(4 * width));
    GString *printed = chafa_canvas_print(canvas, info);
    g_string_prepend(printed, clear_before(info));
    char *text = strdup(printed->str);
    g_string_free(printed, TRUE);
    chafa_canvas_unref(canvas);
    chafa_term_info_unref(info);
    return text;
}

#else

bool cells_exist(void) { return false; }
bool cells_have_pixels(void) { return false; }

char *cells_print(const uint8_t *pixels, uint32_t width, uint32_t height, int columns, int rows,
                  int cell_width, int cell_height)
{
    (void)pixels, (void)width, (void)height, (void)columns, (void)rows, (void)cell_width;
    (void)cell_height;
    return NULL;
}

#endif
