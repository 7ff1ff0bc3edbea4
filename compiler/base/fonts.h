/*
 * fonts.h: fonts of the system, where it has some.
 */
#ifndef KRS_FONTS_H
#define KRS_FONTS_H

/* A font of the system.  `path` is malloc'ed. */
typedef struct FoundFont {
    char *path;
    int   face; /* of several in the file */
} FoundFont;

typedef enum FontSearch {
    FONT_FOUND,
    FONT_UNKNOWN, /* there are fonts, but none of this name */
    FONT_NONE,    /* there are no fonts at all */
    FONT_NO_MEMORY
} FontSearch;

/* Returns the font that a name means, as fontconfig reads it: "DejaVu Serif", "DejaVu Sans:bold".
   NULL: a usual one without serifs. */
FontSearch font_find(const char *name, FoundFont *found);

#endif
