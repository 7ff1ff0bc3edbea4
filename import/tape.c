/*
 * tape.c: tapes of operations, .vm, as fidget reads them.
 *
 * A line `NAME OPERATION ARGUMENT...` gives a name to the result of an operation on the results of
 * earlier lines, and the last line is the solid: below 0 inside.  Each line that counts for it
 * becomes a `let`; numbers and coordinates are written where they are used.
 */
#include "import/tape.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINES = 100000, MAX_ARGUMENTS = 2 };

/* An operation in the words of the language; $a and $b are the arguments.  `blame`: why its slope
   may have no bound. */
typedef struct Operation {
    const char *name;
    int         arguments;
    const char *text, *blame;
} Operation;

#define DIVIDES "divides by what can be 0 in a box of 2 about the origin"
#define JUMPS   "jumps in a box of 2 about the origin"
#define STEEP   "has no greatest slope in a box of 2 about the origin"

static const Operation operations[] = {
    {"const", 0, NULL, NULL}, /* what follows is a number */
    {"var-x", 0, "x", NULL},
    {"var-y", 0, "y", NULL},
    {"var-z", 0, "z", NULL},
    {"neg", 1, "-$a", NULL},
    {"abs", 1, "abs($a)", NULL},
    {"recip", 1, "1 / $a", DIVIDES},
    {"sqrt", 1, "sqrt($a)", STEEP},
    {"square", 1, "$a ^ 2", NULL},
    {"floor", 1, "floor($a)", JUMPS},
    {"ceil", 1, "ceil($a)", JUMPS},
    {"round", 1, "round($a)", JUMPS},
    {"sin", 1, "sin($a)", NULL},
    {"cos", 1, "cos($a)", NULL},
    {"tan", 1, "tan($a)", STEEP},
    {"asin", 1, "asin($a)", STEEP},
    {"acos", 1, "acos($a)", STEEP},
    {"atan", 1, "atan($a)", NULL},
    {"exp", 1, "exp($a)", NULL},
    {"ln", 1, "log($a)", STEEP},
    {"not", 1, "if $a == 0 then 1 else 0", JUMPS},
    {"add", 2, "$a + $b", NULL},
    {"sub", 2, "$a - $b", NULL},
    {"mul", 2, "$a * $b", NULL},
    {"div", 2, "$a / $b", DIVIDES},
    {"min", 2, "min($a, $b)", NULL},
    {"max", 2, "max($a, $b)", NULL},
    {"atan2", 2, "atan2($a, $b)", STEEP},
    {"mod", 2, "mod($a, abs($b))", JUMPS}, /* never negative */
    {"compare", 2, "sign($a - $b)", JUMPS},
    {"and", 2, "if $a == 0 then $a else $b", JUMPS},
    {"or", 2, "if $a == 0 then $b else $a", JUMPS},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

typedef struct Instruction {
    const Operation *operation;
    size_t           arguments[MAX_ARGUMENTS]; /* earlier steps */
    double           number;                   /* of `const` */
    bool             counts, varies;           /* for the result; with the point */
    size_t           ordinal;                  /* among those that are written, from 1 */
    unsigned         line;
} Instruction;

/* The step that a name stands for at the moment; names are interned. */
typedef struct WordMeaning {
    const char *name;
    size_t      instruction;
} WordMeaning;

typedef struct ImportedTape {
    Import  *import;
    unsigned line;
    Names    names;
    struct {
        Instruction *items;
        size_t       count, capacity;
    } instructions;
    WordMeaning *meanings; /* a hash table, open, twice as large as there can be names */
} ImportedTape;

enum { MEANINGS = 1 << 18 };
_Static_assert(MEANINGS >= 2 * MAX_LINES, "a table that is half empty");

static WordMeaning *find_meaning(ImportedTape *tape, const char *name)
{
    size_t slot = ((uintptr_t)name >> 3) * 0x9e3779b97f4a7c15u >> 40;
    for (slot &= MEANINGS - 1; tape->meanings[slot].name; slot = (slot + 1) & (MEANINGS - 1))
        if (tape->meanings[slot].name == name)
            break;
    return &tape->meanings[slot];
}

/* The next word of a line, or one of length 0 at its end. */
typedef struct Word {
    const char *start;
    size_t      length;
} Word;

static Word next_word(const char **at)
{
    while (isspace((unsigned char)**at) && **at != '\n')
        (*at)++;
    Word word = {*at, 0};
    while (!isspace((unsigned char)**at) && **at != '\0')
        (*at)++;
    word.length = (size_t)(*at - word.start);
    return word;
}

static const Operation *find_operation(Word word)
{
    for (size_t i = 0; i < OPERATIONS; i++)
        if (strlen(operations[i].name) == word.length &&
            memcmp(operations[i].name, word.start, word.length) == 0)
            return &operations[i];
    return NULL;
}

/* Returns a word for diagnostics, of which some letters are enough. */
static const char *word_text(const ImportedTape *tape, Word word)
{
    return arena_copy_text(tape->import->arena, word.start, word.length < 60 ? word.length : 60);
}

static bool refuse_operation(ImportedTape *tape, Word word)
{
    const char *names[OPERATIONS];
    for (size_t i = 0; i < OPERATIONS; i++)
        names[i] = operations[i].name;
    const char *written = word_text(tape, word);
    const char *nearest = nearest_name(written, names, OPERATIONS);
    if (nearest)
        return import_refuse(tape->import, tape->line, "no operation is called `%s`; is it `%s`?",
                             written, nearest);
    return import_refuse(tape->import, tape->line, "no operation is called `%s`", written);
}

static bool read_constant(ImportedTape *tape, Instruction *instruction, const char **at)
{
    Word        word   = next_word(at);
    const char *digits = arena_copy_text(tape->import->arena, word.start, word.length);
    char       *end;
    instruction->number = strtod(digits, &end);
    if (word.length == 0)
        return import_refuse(tape->import, tape->line, "`const` needs a number");
    if (*end != '\0' || !isfinite(instruction->number))
        return import_refuse(tape->import, tape->line, "`%s` is not a finite number",
                             word_text(tape, word));
    return true;
}

static bool read_argument(ImportedTape *tape, Instruction *instruction, int index, const char **at)
{
    Word word = next_word(at);
    if (word.length == 0)
        return import_refuse(tape->import, tape->line, "`%s` needs %d argument%s",
                             instruction->operation->name, instruction->operation->arguments,
                             instruction->operation->arguments == 1 ? "" : "s");
    const char        *name    = name_intern(&tape->names, word.start, word.length);
    const WordMeaning *meaning = find_meaning(tape, name);
    if (!meaning->name)
        return import_refuse(tape->import, tape->line, "no line before this one is called `%s`",
                             word_text(tape, word));
    instruction->arguments[index] = meaning->instruction;
    instruction->varies           = instruction->varies ||
                          tape->instructions.items[meaning->instruction].varies;
    return true;
}

static bool read_line(ImportedTape *tape, const char *at)
{
    Word name = next_word(&at);
    if (name.length == 0 || name.start[0] == '#')
        return true;
    if (tape->instructions.count == MAX_LINES)
        return import_refuse(tape->import, tape->line, "more than %d operations", MAX_LINES);
    Word        word        = next_word(&at);
    Instruction instruction = {.operation = find_operation(word), .line = tape->line};
    if (word.length == 0)
        return import_refuse(tape->import, tape->line,
                             "a line is a name, an operation and its arguments: `_2 add _0 _1`");
    if (!instruction.operation)
        return refuse_operation(tape, word);
    instruction.varies = instruction.operation->arguments == 0 && instruction.operation->text;
    if (!instruction.operation->text && !read_constant(tape, &instruction, &at))
        return false;
    for (int i = 0; i < instruction.operation->arguments; i++)
        if (!read_argument(tape, &instruction, i, &at))
            return false;
    if (next_word(&at).length > 0)
        return import_refuse(tape->import, tape->line, "`%s` has too many arguments",
                             instruction.operation->name);
    const char *interned          = name_intern(&tape->names, name.start, (size_t)name.length);
    *find_meaning(tape, interned) = (WordMeaning){interned, tape->instructions.count};
    array_push(tape->import->arena, &tape->instructions, instruction);
    return true;
}

static bool read_tape(ImportedTape *tape)
{
    const char *at = tape->import->bytes;
    while (*at != '\0') {
        tape->line++;
        if (!read_line(tape, at))
            return false;
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    if (tape->instructions.count == 0)
        return import_refuse(tape->import, tape->line + (tape->line == 0), "there is no operation");
    if (!tape->instructions.items[tape->instructions.count - 1].varies)
        return import_refuse(tape->import, tape->line,
                             "what comes last does not depend on x, y or z");
    return true;
}

/* ---- writing ---- */

/* Writes what a step is called where it is used. */
static void write_name(const ImportedTape *tape, size_t index)
{
    const Instruction *instruction = &tape->instructions.items[index];
    Text              *text        = &tape->import->scene;
    if (instruction->operation->arguments > 0) {
        text_format(text, "n%zu", instruction->ordinal);
    } else if (instruction->operation->text) {
        text_add(text, instruction->operation->text);
    } else {
        text_add(text, instruction->number < 0 ? "(" : "");
        import_add_number(text, instruction->number);
        text_add(text, instruction->number < 0 ? ")" : "");
    }
}

static void write_instruction(const ImportedTape *tape, const Instruction *instruction)
{
    Text *text = &tape->import->scene;
    import_mark(tape->import, instruction->line);
    text_format(text, "let n%zu = ", instruction->ordinal);
    for (const char *at = instruction->operation->text; *at != '\0'; at++) {
        if (*at == '$')
            write_name(tape, instruction->arguments[*++at - 'a']);
        else
            text_add_bytes(text, at, 1);
    }
    text_add(text, ";\n");
    if (instruction->operation->blame)
        import_blame(tape->import, instruction->line, "`%s` %s", instruction->operation->name,
                     instruction->operation->blame);
}

static void write_tape(ImportedTape *tape)
{
    size_t last = tape->instructions.count - 1, ordinal = 0;
    Text  *text                           = &tape->import->scene;
    tape->instructions.items[last].counts = true;
    for (size_t i = last + 1; i-- > 0;) {
        const Instruction *instruction = &tape->instructions.items[i];
        for (int k = 0; instruction->counts && k < instruction->operation->arguments; k++)
            tape->instructions.items[instruction->arguments[k]].counts = true;
    }
    text_format(text, "// From %s.\n\n", tape->import->name);
    for (size_t i = 0; i <= last; i++) {
        Instruction *instruction = &tape->instructions.items[i];
        if (!instruction->counts || instruction->operation->arguments == 0)
            continue;
        instruction->ordinal = ++ordinal;
        write_instruction(tape, instruction);
    }
    import_mark(tape->import, tape->instructions.items[last].line);
    text_add(text, "\n// A tape has no bounds; this is what its viewers show unless asked.\n"
                   "show field(");
    write_name(tape, last);
    text_add(text, ").within(box([2, 2, 2]));\n");
}

bool import_tape(Import *import)
{
    ImportedTape tape = {.import = import, .names = {.arena = import->arena}};
    tape.meanings     = arena_new_array(import->arena, WordMeaning, MEANINGS);
    if (!read_tape(&tape))
        return false;
    write_tape(&tape);
    return true;
}
