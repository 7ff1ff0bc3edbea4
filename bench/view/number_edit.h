/*
 * number_edit.h: a number of a scene's text that changes no shader when it is edited.
 */
#ifndef KRS_BENCH_NUMBER_EDIT_H
#define KRS_BENCH_NUMBER_EDIT_H

#include "live/text/document.h"

typedef struct NumberEdit {
    const char *path;
    size_t      at;    /* of the last digit of the number; 0: there is no such number */
    char        other; /* the digit that the next edit puts there; both are known to compile */
} NumberEdit;

/* Looks for a number behind the offset `from` of a file that the document, of the same path, has read;
   its numbers must be no literals of shaders.  What is found is edited in the file, and read. */
NumberEdit number_edit_find(Document *document, const char *path, size_t from);

/* Writes the file with the other digit.  Ends the process where that fails. */
void number_edit_write(NumberEdit *edit);

#endif
