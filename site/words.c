/*
 * words.c: prints the words of the language as JSON, as the library lists them.
 */
#include <stdio.h>
#include <stdlib.h>

#include "krs/krs.h"

int main(void)
{
    char *json = NULL;
    if (krs_words(NULL, &json) != KRS_OK)
        return EXIT_FAILURE;
    puts(json);
    free(json);
    return ferror(stdout) ? EXIT_FAILURE : EXIT_SUCCESS;
}
