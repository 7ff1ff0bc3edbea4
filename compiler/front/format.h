/*
 * format.h: the canonical layout of a scene's text.
 *
 * Words and the breaks between lines are the author's; the layout decides on blanks alone:
 *
 *   - Between two words of a line there is one blank or none, by their kinds.  There are more only
 *     where the author has set words of neighbouring lines below each other, as the `=` of several
 *     definitions.  Such columns are as far to the left as their words permit.
 *   - A statement begins four columns to the right of the line whose brace holds it.  The lines that
 *     go on with a statement are indented by four more, or are as far to the right as a value of a
 *     line above below which the author has set them.
 *   - Of several empty lines one stays; none at the beginning and at the end.
 *
 * What has the canonical layout is not changed.
 */
#ifndef KRS_FORMAT_H
#define KRS_FORMAT_H

#include "compiler/front/token.h"

/* Adds a source in canonical layout to `out`.  The source has no mistakes that lex and parse report.
   False, should a word or comment not be the same in the new text: a bug. */
bool format_source(uint32_t source, Sources *sources, Arena *arena, Text *out);

#endif
