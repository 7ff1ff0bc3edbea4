/*
 * json.c: JSON that is written member by member.
 */
#include "compiler/base/json.h"

#include <stdio.h>

/* Adds what stands before a member or an element. */
static void begin(Json *json, const char *name)
{
    if (json->more)
        text_add(&json->text, json->spaced ? ", " : ",");
    json->more = true;
    if (!name)
        return;
    text_json(&json->text, name);
    text_add(&json->text, json->spaced ? ": " : ":");
}

void json_open(Json *json, const char *name, const char *bracket)
{
    begin(json, name);
    text_add(&json->text, bracket);
    json->more = false;
}

void json_close(Json *json, const char *bracket)
{
    text_add(&json->text, bracket);
    json->more = true;
}

void json_text(Json *json, const char *name, const char *string)
{
    begin(json, name);
    if (string)
        text_json(&json->text, string);
    else
        text_add(&json->text, "null");
}

void json_whole(Json *json, const char *name, uint64_t number)
{
    char   digits[20];
    size_t first = sizeof digits;
    begin(json, name);
    do
        digits[--first] = (char)('0' + number % 10);
    while ((number /= 10) > 0);
    text_add_bytes(&json->text, digits + first, sizeof digits - first);
}

void json_truth(Json *json, const char *name, bool truth)
{
    begin(json, name);
    text_add(&json->text, truth ? "true" : "false");
}

void json_number(Json *json, const char *name, double number)
{
    begin(json, name);
    text_json_number(&json->text, number);
}

void json_numbers(Json *json, const char *name, const double *numbers, size_t count)
{
    json_open(json, name, "[");
    for (size_t i = 0; i < count; i++)
        json_number(json, NULL, numbers[i]);
    json_close(json, "]");
}

void json_rounded(Json *json, const char *name, double number)
{
    begin(json, name);
    char printed[400]; /* of the largest numbers */
    snprintf(printed, sizeof printed, "%.3f", number);
    text_printed_number(&json->text, printed);
}

void json_ready(Json *json, const char *name, const char *value)
{
    begin(json, name);
    text_add(&json->text, value);
}
