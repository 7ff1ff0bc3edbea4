/*
 * import_text.c: words about an imported file, and numbers as scenes have them.
 */
#include "cli/import_text.h"

#include "cli/console.h"

bool import_refuse(const Import *import, unsigned line, const char *format, ...)
{
    Text    words = {.arena = import->arena};
    va_list arguments;
    va_start(arguments, format);
    text_format_list(&words, format, arguments);
    va_end(arguments);
    for (char *at = words.bytes; *at != '\0'; at++)
        if ((unsigned char)*at < ' ' || *at == 0x7f) /* what a file says moves no cursor */
            *at = '?';
    say("%s:%u: %s", import->path, line, words.bytes);
    return false;
}

void import_add_number(Text *text, double number)
{
    text_number(text, number == 0 ? 0 : number); /* never -0 */
}

void import_add_vector(Text *text, const double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        text_add(text, i == 0 ? "[" : ", ");
        import_add_number(text, numbers[i]);
    }
    text_add(text, "]");
}
