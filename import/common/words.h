/*
 * words.h: the words of files that describe scenes as programs do: names, numbers, strings
 * and signs, with comments as in C.
 */
#ifndef KRS_IMPORT_WORDS_H
#define KRS_IMPORT_WORDS_H

#include "import/common/text.h"

typedef enum ImportWordKind {
    IMPORT_WORD_END, /* also after a refusal */
    IMPORT_WORD_NUMBER,
    IMPORT_WORD_NAME, /* may begin with `$` */
    IMPORT_WORD_STRING,
    IMPORT_WORD_SIGN,
    IMPORT_WORD_HELD /* for those who read words in their own way: not ready yet */
} ImportWordKind;

typedef struct ImportWord {
    ImportWordKind kind;
    const char    *text; /* of a string, what is between its quotes */
    double         number;
    unsigned       line;
} ImportWord;

typedef struct WordReader {
    Import     *import;
    const char *at;
    unsigned    line;
    bool        nested;                      /* comments may contain comments */
    ImportWord  word;                        /* the next one */
    void (*next)(struct WordReader *reader); /* how to go on, or NULL: word by word */
    void *user;
} WordReader;

/* The first word of the file is then the next one. */
void words_start(WordReader *reader, Import *import, bool nested);
void words_advance(WordReader *reader);
/* Goes to the next word likewise, whatever `next` is. */
void words_advance_plain(WordReader *reader);

/* Tells whether the next word is this name or sign. */
bool word_is(const WordReader *reader, const char *text);
/* Returns which of these names or signs the next word is; -1: none of them. */
int word_index(const WordReader *reader, const char *const *names, size_t count);
#define word_among(reader, names) \
    (word_index((reader), (names), sizeof(names) / sizeof *(names)) >= 0)
/* Goes on if the next word is this name or sign. */
bool word_accept(WordReader *reader, const char *text);
/* Refuses the file if it is not. */
bool word_expect(WordReader *reader, const char *text);
/* Reports "there should be WHAT, not ..."; returns false. */
bool word_refuse(WordReader *reader, const char *what);

#endif
