/*
 * json.h: JSON that is written member by member.
 */
#ifndef KRS_JSON_H
#define KRS_JSON_H

#include <stdbool.h>

#include "compiler/base/text.h"

typedef struct Json {
    Text text;
    bool more; /* something stands before what comes next */
} Json;

/* Each of these writes a member; an element of an array, or a value alone, if the name is NULL. */
void json_open(Json *json, const char *name, const char *bracket);
void json_close(Json *json, const char *bracket);
void json_string(Json *json, const char *name, const char *string); /* NULL: null */
void json_whole(Json *json, const char *name, uint32_t number);
void json_truth(Json *json, const char *name, bool truth);
/* Writes a value that is JSON already. */
void json_ready(Json *json, const char *name, const char *value);

#endif
