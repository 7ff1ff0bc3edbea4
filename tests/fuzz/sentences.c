/*
 * sentences.c: the parser accepts what the grammar permits.
 *
 * Reads grammar/krs.ebnf, makes random sentences from it, and has them parsed: none may get a
 * diagnostic.  Without one of its closing brackets a sentence must be refused.  Prints TAP.
 *
 *     sentences [COUNT [SEED]]
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/front/format.h"
#include "compiler/front/parse.h"

/* ---- the grammar ---- */

typedef enum PartKind {
    PART_SEQUENCE,
    PART_CHOICE,
    PART_OPTIONAL,
    PART_REPEAT,
    PART_WORD,
    PART_RULE
} PartKind;

/* A piece of the right side of a rule. */
typedef struct Part {
    PartKind    kind;
    const char *word; /* WORD: the text, or the name of a class like NUMBER; RULE: its name */
    bool        quoted;
    struct {
        struct Part **items;
        size_t        count, capacity;
    } parts;
    int height; /* rules that must be entered at least */
} Part;

typedef struct Rule {
    const char *name;
    Part       *part;
    bool        used;
} Rule;

typedef struct Grammar {
    Arena *arena;
    struct {
        Rule  *items;
        size_t count, capacity;
    } rules;
    const char *at; /* while reading */
    uint64_t    random;
    int         words; /* that the sentence may still have before it is brought to an end */
} Grammar;

enum { UNREACHABLE = 1000000 };

static Rule *find_rule(Grammar *g, const char *name)
{
    for (size_t i = 0; i < g->rules.count; i++)
        if (strcmp(g->rules.items[i].name, name) == 0)
            return &g->rules.items[i];
    printf("Bail out! the grammar has no rule `%s`\n", name);
    exit(1);
}

static Part *part_new(Grammar *g, PartKind kind)
{
    Part *part = arena_new(g->arena, Part);
    part->kind = kind;
    return part;
}

static void skip_blanks(Grammar *g) { g->at += strspn(g->at, " "); }

static const char *read_word(Grammar *g, size_t length)
{
    const char *word = arena_copy_text(g->arena, g->at, length);
    g->at += length;
    return word;
}

static Part *read_choice(Grammar *g, char closer);

static Part *read_part(Grammar *g)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    Part             *part;
    if (*g->at == '(' || *g->at == '[' || *g->at == '{') {
        char open = *g->at++;
        part = part_new(g, open == '[' ? PART_OPTIONAL : open == '{' ? PART_REPEAT : PART_SEQUENCE);
        Part *inside = read_choice(g, open == '[' ? ']' : open == '{' ? '}' : ')');
        array_push(g->arena, &part->parts, inside);
    } else if (*g->at == '"') {
        g->at++;
        part         = part_new(g, PART_WORD);
        part->word   = read_word(g, strcspn(g->at, "\""));
        part->quoted = true;
        g->at++;
    } else {
        size_t length = strspn(g->at, letters);
        if (length == 0) {
            printf("Bail out! the grammar cannot be read at `%.20s`\n", g->at);
            exit(1);
        }
        part       = part_new(g, *g->at < 'a' ? PART_WORD : PART_RULE);
        part->word = read_word(g, length);
    }
    skip_blanks(g);
    return part;
}

/* Alternatives up to a closing sign, which is read too. */
static Part *read_choice(Grammar *g, char closer)
{
    Part *choice   = part_new(g, PART_CHOICE);
    Part *sequence = part_new(g, PART_SEQUENCE);
    skip_blanks(g);
    while (*g->at != closer) {
        if (*g->at == '|') {
            array_push(g->arena, &choice->parts, sequence);
            sequence = part_new(g, PART_SEQUENCE);
            g->at++;
            skip_blanks(g);
        } else
            array_push(g->arena, &sequence->parts, read_part(g));
    }
    g->at++;
    array_push(g->arena, &choice->parts, sequence);
    return choice;
}

static void read_rule(Grammar *g, const char *line)
{
    if (line[0] == '#' || line[0] == '\n' || line[0] == '\0')
        return;
    g->at     = line;
    Rule rule = {.name = read_word(g, strcspn(line, " "))};
    skip_blanks(g);
    g->at++; /* = */
    rule.part = read_choice(g, ';');
    array_push(g->arena, &g->rules, rule);
}

static void read_grammar(Grammar *g, const char *path)
{
    FILE *file = fopen(path, "r");
    char  line[1000];
    if (!file) {
        printf("Bail out! cannot open %s\n", path);
        exit(1);
    }
    while (fgets(line, sizeof line, file))
        read_rule(g, line);
    fclose(file);
}

/* ---- how soon a part can come to an end ---- */

static int height_of(Grammar *g, Part *part)
{
    int height = part->kind == PART_CHOICE ? UNREACHABLE : 0;
    for (size_t i = 0; i < part->parts.count; i++) {
        int other = height_of(g, part->parts.items[i]);
        if (part->kind == PART_CHOICE ? other < height : other > height)
            height = other;
    }
    if (part->kind == PART_OPTIONAL || part->kind == PART_REPEAT)
        height = 0;
    if (part->kind == PART_RULE)
        height = 1 + find_rule(g, part->word)->part->height;
    return part->height = height < UNREACHABLE ? height : UNREACHABLE;
}

static void find_heights(Grammar *g)
{
    for (size_t i = 0; i < g->rules.count; i++)
        g->rules.items[i].part->height = UNREACHABLE;
    for (size_t round = 0; round <= g->rules.count; round++)
        for (size_t i = 0; i < g->rules.count; i++)
            height_of(g, g->rules.items[i].part);
}

/* ---- sentences ---- */

/* xorshift64*. */
static uint32_t random_below(Grammar *g, uint32_t end)
{
    g->random ^= g->random >> 12;
    g->random ^= g->random << 25;
    g->random ^= g->random >> 27;
    return (uint32_t)((g->random * 0x2545F4914F6CDD1Du) >> 33) % end;
}

static const char *pick(Grammar *g, const char *const *words, uint32_t count)
{
    return words[random_below(g, count)];
}

#define PICK(g, words) pick((g), (words), sizeof(words) / sizeof *(words))

static const char *example_of(Grammar *g, const char *class)
{
    static const char *const numbers[] = {"0",    "1",     "0.5",     "12.25",
                                          "1e-3", "30deg", "2.5e+10", "007"};
    static const char *const colours[] = {"#000000", "#c8553d", "#FFffFF"};
    static const char *const strings[] = {"\"\"", "\"std/trees.krs\"", "\"a \\\"b\\\" \\n\""};
    static const char *const names[]   = {"a", "kernel", "_private", "reflect", "n2",    "Mobius",
                                          "x", "deg",    "e1",       "iffy",    "mobius"};
    static const char *const words[]   = {
#define STATEMENT(spelling) spelling,
#define SPECIAL(spelling)
#define CONTROL(spelling)
#define OPERATOR_WORD(spelling)
#define CONSTANT(spelling)
#define PUNCTUATION(spelling)
#define OPERATOR(spelling)
#define TOKEN(name, spelling, class) class(spelling)
#include "compiler/front/token.def"
#undef TOKEN
    };
    static const char *const kinds[] = {
#define KIND(name, latest, many, check, wanted) #name,
#include "compiler/front/kinds.def"
#undef KIND
    };
    if (strcmp(class, "KIND") == 0)
        return PICK(g, kinds);
    if (strcmp(class, "NUMBER") == 0)
        return PICK(g, numbers);
    if (strcmp(class, "COLOUR") == 0)
        return PICK(g, colours);
    if (strcmp(class, "STRING") == 0)
        return PICK(g, strings);
    if (strcmp(class, "NAME") == 0)
        return PICK(g, names);
    if (strcmp(class, "STATEMENT_WORD") == 0)
        return PICK(g, words);
    printf("Bail out! the grammar has an unknown class `%s`\n", class);
    exit(1);
}

static void add_word(Grammar *g, const char *word, Text *out)
{
    static const char *const blanks[] = {
        " ", " ", " ", " ", "\n", "\t", "\r\n", " // words\n", " /* ; */ ", "\n/// a note\n"};
    text_add(out, word);
    text_add(out, PICK(g, blanks));
    g->words--;
}

/* Writes something that fits a part; with little `room` left the shortest way is taken. */
static void make(Grammar *g, const Part *part, int room, Text *out)
{
    const Part *only  = part->parts.count ? part->parts.items[0] : NULL;
    uint32_t    times = 0;
    if (g->words <= 0)
        room = 0;
    switch (part->kind) {
    case PART_WORD: add_word(g, part->quoted ? part->word : example_of(g, part->word), out); break;
    case PART_RULE: {
        Rule *rule = find_rule(g, part->word);
        rule->used = true;
        if (random_below(g, 6) == 0) /* so that something is left for what comes after */
            room = (int)random_below(g, (uint32_t)(room > 0 ? room : 0) + 1);
        make(g, rule->part, room - 1, out);
        break;
    }
    case PART_SEQUENCE:
        for (size_t i = 0; i < part->parts.count; i++)
            make(g, part->parts.items[i], room, out);
        break;
    case PART_CHOICE: {
        const Part *chosen = part->parts.items[random_below(g, (uint32_t)part->parts.count)];
        for (size_t i = 0; chosen->height > room && i < part->parts.count; i++)
            if (part->parts.items[i]->height == part->height)
                chosen = part->parts.items[i];
        make(g, chosen, room, out);
        break;
    }
    case PART_OPTIONAL:
    case PART_REPEAT:
        if (room > only->height)
            times = random_below(g, part->kind == PART_REPEAT ? 4 : 2);
        for (uint32_t i = 0; i < times; i++)
            make(g, only, room, out);
        break;
    }
}

/* ---- the tests ---- */

/* Parses a text; prints what is wrong as comments if nothing should be. */
static bool is_accepted(const char *text, size_t length, bool should_be, Arena *arena)
{
    Sources  sources = {.arena = arena};
    Names    names   = {.arena = arena};
    Diags    diags   = {.arena = arena, .sources = &sources};
    uint32_t source  = source_add(&sources, "sentence.krs", text, length, false);
    Tokens   tokens  = lex(source, &sources, &names, &diags, arena);
    parse(&tokens, &diags, arena);
    if (diags.count > 0 && should_be) {
        Text out = {.arena = arena};
        diags_print_text(&diags, false, &out);
        printf("# ");
        for (size_t i = 0; i < out.length; i++)
            if (out.bytes[i] == '\n')
                printf("\n# ");
            else
                putchar(out.bytes[i]);
        printf("\n");
    }
    return diags.count == 0;
}

/* Returns the tree of a text as krs dumps it, but without places. */
static Text tree_of(const char *bytes, size_t length, Arena *arena)
{
    Sources  sources = {.arena = arena};
    Names    names   = {.arena = arena};
    Diags    diags   = {.arena = arena, .sources = &sources};
    uint32_t source  = source_add(&sources, "sentence.krs", bytes, length, false);
    Tokens   tokens  = lex(source, &sources, &names, &diags, arena);
    Text     whole = {.arena = arena}, tree = {.arena = arena};
    syntax_print(parse(&tokens, &diags, arena), &sources, &whole);
    for (size_t at = 0, end; at < whole.length; at = end + 1) {
        end         = at + strcspn(whole.bytes + at, "\n");
        size_t last = end;
        while (last > at && whole.bytes[last] != ' ')
            last--;
        text_add_bytes(&tree, whole.bytes + at, last - at);
        text_add(&tree, "\n");
    }
    return tree;
}

static Text without_blanks(const Text *text)
{
    Text out = {.arena = text->arena};
    for (size_t i = 0; i < text->length; i++)
        if (!strchr(" \t\r\n", text->bytes[i]))
            text_add_bytes(&out, &text->bytes[i], 1);
    return out;
}

static bool are_equal(const Text *a, const Text *b)
{
    return a->length == b->length && (a->length == 0 || memcmp(a->bytes, b->bytes, a->length) == 0);
}

static bool has_blanks_at_ends(const Text *text)
{
    for (size_t i = 1; i < text->length; i++)
        if (text->bytes[i] == '\n' && strchr(" \t\r", text->bytes[i - 1]))
            return true;
    return text->length > 0 && text->bytes[text->length - 1] != '\n';
}

static Text format(const Text *text)
{
    Text     out     = {.arena = text->arena};
    Sources  sources = {.arena = text->arena};
    uint32_t source  = source_add(&sources, "", text->length ? text->bytes : "", text->length,
                                  false);
    if (!format_source(source, &sources, text->arena, &out))
        text_add(&out, "not the same words");
    return out;
}

/* Tells whether the canonical layout changes blanks alone, and nothing the second time. */
static bool is_formatted(const Text *sentence)
{
    Text formatted = format(sentence), again = format(&formatted);
    Text words = without_blanks(sentence), formatted_words = without_blanks(&formatted);
    Text tree  = tree_of(sentence->bytes, sentence->length, sentence->arena);
    Text other = tree_of(formatted.length ? formatted.bytes : "", formatted.length,
                         sentence->arena);
    bool good  = are_equal(&words, &formatted_words) && are_equal(&tree, &other) &&
                are_equal(&formatted, &again) && !has_blanks_at_ends(&formatted);
    if (!good && getenv("KRS_TEST_SHOW"))
        printf("---- sentence\n%s\n---- formatted\n%s\n---- again\n%s\n", sentence->bytes,
               formatted.bytes, again.bytes);
    return good;
}

/* Takes one closing bracket out, at random; false when there is none.  Brackets in strings and
   comments do not occur. */
static bool drop_closer(Grammar *g, Text *sentence)
{
    uint32_t count = 0;
    for (size_t i = 0; i < sentence->length; i++)
        count += strchr(")]}", sentence->bytes[i]) != NULL;
    if (count == 0)
        return false;
    uint32_t chosen = random_below(g, count);
    for (size_t i = 0; i < sentence->length; i++)
        if (strchr(")]}", sentence->bytes[i]) && chosen-- == 0)
            sentence->bytes[i] = ' ';
    return true;
}

static bool report(int number, bool good, const char *name)
{
    printf("%sok %d - %s\n", good ? "" : "not ", number, name);
    return good;
}

int main(int argc, char **argv)
{
    long          count = argc > 1 ? strtol(argv[1], NULL, 10) : 5000;
    long          seed  = argc > 2 ? strtol(argv[2], NULL, 10) : 1;
    jmp_buf       exhausted;
    Memory        memory = {.exhausted = &exhausted};
    Arena         fixed = {.memory = &memory}, each = {.memory = &memory};
    Grammar       grammar = {.arena = &fixed};
    volatile long refused = 0, wrong = 0, cut = 0, untidy = 0;
    if (setjmp(exhausted)) {
        printf("Bail out! out of memory\n");
        return 1;
    }
    read_grammar(&grammar, "grammar/krs.ebnf");
    find_heights(&grammar);
    for (long i = 0; i < count; i++) {
        grammar.random = (uint64_t)(seed + i) * 0x9E3779B97F4A7C15u | 1;
        Text sentence  = {.arena = &each};
        text_add(&sentence, "");
        grammar.words = (int)random_below(&grammar, 600);
        int room      = 40 + (int)random_below(&grammar, 100);
        make(&grammar, find_rule(&grammar, "file")->part, room, &sentence);
        refused += !is_accepted(sentence.bytes, sentence.length, true, &each);
        untidy += !is_formatted(&sentence);
        if (drop_closer(&grammar, &sentence)) {
            cut++;
            wrong += is_accepted(sentence.bytes, sentence.length, false, &each);
        }
        arena_free(&each);
    }
    bool all_used = true;
    for (size_t i = 0; i < grammar.rules.count; i++)
        if (!grammar.rules.items[i].used && strcmp(grammar.rules.items[i].name, "file") != 0) {
            printf("# never used: %s\n", grammar.rules.items[i].name);
            all_used = false;
        }
    arena_free(&fixed);
    printf("1..4\n# %ld sentences from seed %ld, %ld without a bracket\n", count, seed, (long)cut);
    bool accepts = report(1, refused == 0 && count > 0, "sentences of the grammar are accepted");
    bool refuses = report(2, wrong == 0 && cut > 0, "sentences without a closing bracket are not");
    bool reaches = report(3, all_used, "the sentences use every rule");
    bool keeps   = report(4, untidy == 0,
                          "the canonical layout changes blanks alone, and is its own");
    return accepts && refuses && reaches && keeps ? 0 : 1;
}
