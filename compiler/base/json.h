/*
 * json.h: JSON that is written member by member.  No name is one of jansson, which the command links, too.
 */
#ifndef KRS_JSON_H
#define KRS_JSON_H

#include <stdbool.h>

#include "compiler/base/text.h"

typedef struct Json {
    Text text;
    bool spaced; /* blanks stand behind commas and colons */
    bool more;   /* something stands before what comes next */
} Json;

/* Each of these writes a member; an element of an array, or a value alone, if the name is NULL. */
void json_open(Json *json, const char *name, const char *bracket);
void json_close(Json *json, const char *bracket);
void json_text(Json *json, const char *name, const char *string); /* NULL: null */
void json_whole(Json *json, const char *name, uint64_t number);
void json_truth(Json *json, const char *name, bool truth);
/* Writes the shortest decimals that read back as the numbers; what is not finite becomes null. */
void json_number(Json *json, const char *name, double number);
void json_numbers(Json *json, const char *name, const double *numbers, size_t count);
/* Writes a number with three decimals. */
void json_rounded(Json *json, const char *name, double number);
/* Writes a value that is JSON already. */
void json_ready(Json *json, const char *name, const char *value);

#endif
