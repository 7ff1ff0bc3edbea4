/*
 * evaluate.c: the value of a param, as an expression of the language: `0.5 + 1/4`, `tomato`, `2*pi`.
 *
 * It is the default of the only param of a scene that consists of that.
 */
#include <string.h>

#include "cli/shell/console.h"
#include "cli/options/values.h"
#include "compiler/base/text.h"

/* Keeps the first mistake in a value. */
static void listen(void *user, const KrsDiagnostic *diagnostic)
{
    Text *said = user;
    if (diagnostic->error && said->length == 0)
        text_add(said, diagnostic->message);
}

/* Tells whether a text has a comma outside of brackets: a vector whose brackets are left out. */
static bool is_bare_vector(const char *text)
{
    int depth = 0;
    for (; *text; text++) {
        depth += *text == '(' || *text == '[';
        depth -= *text == ')' || *text == ']';
        if (*text == ',' && depth == 0)
            return true;
    }
    return false;
}

static bool take_default(const KrsScene *scene, Setting *setting)
{
    KrsParameter parameter;
    if (krs_parameter(scene, 0, &parameter) != KRS_OK)
        return false;
    setting->count = parameter.components;
    memcpy(setting->values, parameter.value, sizeof setting->values);
    return true;
}

bool read_expression(Arena *arena, const char *text, Setting *setting)
{
    Text       scene = {.arena = arena}, said = {.arena = arena};
    KrsOptions options = {.diagnostic = listen, .user = &said};
    KrsScene  *result  = NULL;
    if (text[0] == '\0' || strchr(text, ';'))
        return false;
    bool bare = is_bare_vector(text);
    text_format(&scene, "param value = %c%s%c;", bare ? '[' : '(', text, bare ? ']' : ')');
    bool done = krs_compile_text(scene.bytes, scene.length, "--set", &options, &result) == KRS_OK &&
                take_default(result, setting);
    krs_scene_free(result);
    if (!done && said.length > 0)
        say("`%s` in --set %s: %s", text, setting->name, said.bytes);
    return done;
}
