/*
 * data.h: files of data that a scene reads: a cursor over their text, for the files of this folder.
 *
 * Mistakes are marked in the data file, and where it is read.
 */
#ifndef KRS_DATA_H
#define KRS_DATA_H

#include "compiler/eval/data/from_files.h"

typedef struct DataText {
    Elaboration  *e;
    const Syntax *call; /* the `read_...` */
    const char   *text; /* NUL-terminated */
    uint32_t      source, length, at;
    size_t        values;  /* read so far */
    Text          scratch; /* the string being read */
} DataText;

/* Opens the file that the first argument of a call names; false: reported. */
bool data_open(Elaboration *e, const Call *call, DataText *data);
/* Reports that bytes [start, end) are not what such a file has. */
Diag *data_error(DataText *data, uint32_t start, uint32_t end, const char *message);
/* Returns the length of the number that begins at a place, 0 without one.  `strict`: as JSON has
   it; else also with `+`, zeros before it, and a point without digits on one side. */
uint32_t data_number_length(const DataText *data, uint32_t start, bool strict);
/* Reads a number; VALUE_ERROR: it is too large, which is reported. */
Value data_number(DataText *data, uint32_t start, uint32_t end);
/* Returns a string of what was gathered in `scratch`; it may hold no NUL and must be UTF-8. */
Value data_string(DataText *data, uint32_t start, uint32_t end);
/* Adds an element to a list; false: too many, which is reported. */
bool data_push(DataText *data, Values *values, Value value);

#endif
