/*
 * fonts.c: finds fonts of the system, by fontconfig.
 */
#include "compiler/base/fonts.h"

#include <errno.h>
#include <fontconfig/fontconfig.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "compiler/base/unchecked.h"

/* Tells whether a match has a family that was asked for, and not another one instead. */
static bool has_family(const FcPattern *asked, const FcPattern *match)
{
    FcChar8 *wanted, *family;
    if (FcPatternGetString(asked, FC_FAMILY, 0, &wanted) != FcResultMatch)
        return true;
    for (int i = 0; FcPatternGetString(match, FC_FAMILY, i, &family) == FcResultMatch; i++)
        if (strcasecmp((const char *)wanted, (const char *)family) == 0)
            return true;
    return false;
}

static bool is_generic(const char *name)
{
    return strcasecmp(name, "sans") == 0 || strcasecmp(name, "serif") == 0 ||
           strcasecmp(name, "mono") == 0 || strcasecmp(name, "monospace") == 0 ||
           strcasecmp(name, "sans-serif") == 0;
}

static FontSearch match_font(FcConfig *config, const char *name, bool any, FoundFont *found)
{
    FcResult   result = FcResultMatch;
    FcPattern *asked  = FcNameParse((const FcChar8 *)name);
    if (!asked)
        return errno == ENOMEM ? FONT_NO_MEMORY : FONT_UNKNOWN;
    FcPattern *filled = FcPatternDuplicate(asked);
    if (!filled || !FcPatternAddBool(filled, FC_SCALABLE, FcTrue) ||
        !FcConfigSubstitute(config, filled, FcMatchPattern)) {
        if (filled)
            FcPatternDestroy(filled);
        FcPatternDestroy(asked);
        return FONT_NO_MEMORY;
    }
    FcDefaultSubstitute(filled);
    FcPattern *match  = FcFontMatch(config, filled, &result);
    FontSearch search = result == FcResultOutOfMemory ? FONT_NO_MEMORY : FONT_NONE;
    FcChar8   *path;
    if (match && FcPatternGetString(match, FC_FILE, 0, &path) == FcResultMatch) {
        search = any || has_family(asked, match) ? FONT_FOUND : FONT_UNKNOWN;
        if (search == FONT_FOUND) {
            found->path = strdup((const char *)path);
            FcPatternGetInteger(match, FC_INDEX, 0, &found->face);
        }
    }
    if (match)
        FcPatternDestroy(match);
    FcPatternDestroy(filled);
    FcPatternDestroy(asked);
    return search;
}

static FontSearch search_fonts(const char *name, FoundFont *found)
{
    errno            = 0;
    FcConfig *config = FcInitLoadConfigAndFonts();
    if (!config)
        return errno == ENOMEM ? FONT_NO_MEMORY : FONT_NONE;
    FontSearch search = match_font(config, name ? name : "DejaVu Sans", name && is_generic(name),
                                   found);
    if (!name && search == FONT_UNKNOWN)
        search = match_font(config, "sans-serif", true, found);
    FcConfigDestroy(config);
    return search == FONT_FOUND && !found->path ? FONT_NO_MEMORY : search;
}

/* Finds a font.  fontconfig goes on without fonts where it could not allocate something: a second
   time says whether there are none. */
FontSearch font_find(const char *name, FoundFont *found)
{
    FontSearch search = FONT_NONE;
    *found            = (FoundFont){0};
    unchecked_begin();
    for (int i = 0; i < 2 && search == FONT_NONE; i++)
        search = search_fonts(name, found);
    unchecked_end();
    return search;
}
