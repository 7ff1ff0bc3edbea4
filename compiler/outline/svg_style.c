/*
 * svg_style.c: what CSS says of an element: selectors of names, classes and ids, alone or inside of
 * others.
 *
 * The order is that of CSS: `!important`, the attribute `style`, rules by the weight of their selectors,
 * and attributes that are named as properties last.
 */
#include <ctype.h>
#include <string.h>

#include "compiler/outline/svg_tree.h"

/* Weights are ids, classes and names, eight bits each; then whether it is important. */
enum { WEIGHT_NAME = 1, WEIGHT_CLASS = 1 << 8, WEIGHT_ID = 1 << 16, WEIGHT_IMPORTANT = 1 << 24 };

static bool is_of_name(char c)
{
    return isalnum((unsigned char)c) || c == '-' || c == '_' || (unsigned char)c >= 0x80;
}

/* ---- selectors ---- */

static bool has_word(const char *list, const char *word, size_t length)
{
    while (list && *list) {
        while (svg_is_blank(*list))
            list++;
        size_t own = strcspn(list, " \t\r\n\f");
        if (own == length && length > 0 && strncmp(list, word, length) == 0)
            return true;
        list += own;
    }
    return false;
}

/* Tells whether an element matches a selector without blanks: "path", ".thin", "#wall",
   "path.thin#wall", "*". */
static bool matches_simple(const SvgElement *element, const char *text, size_t length)
{
    for (size_t at = 0, end; at < length; at = end) {
        bool        marked = text[at] == '.' || text[at] == '#';
        const char *name   = text + at + marked;
        for (end = at + 1; end < length && is_of_name(text[end]);)
            end++;
        size_t size = end - at - marked;
        if (text[at] == '.'   ? !has_word(svg_attribute(element, "class"), name, size)
            : text[at] == '#' ? !has_word(svg_attribute(element, "id"), name, size)
                              : text[at] != '*' && (strlen(element->name) != size ||
                                                    strncmp(element->name, name, size) != 0))
            return false;
    }
    return true;
}

/* How a selector and an element go together.  FAILS_AROUND: nor does it match any element around this one,
   since what it asks for was looked for up to the root. */
typedef enum Match { MATCHES, FAILS, FAILS_AROUND } Match;

/* Matches a selector from its end on: "g .thin" is inside of a `g`, however deep, "g > .thin" a child of
   one.  The nearest `g` that matches decides, as the ones around it have less around them.  So the time
   grows with the depth and not with its powers. */
static Match match(const SvgElement *element, const char *text, size_t length)
{
    size_t from;
    while (length > 0 && svg_is_blank(text[length - 1]))
        length--;
    for (from = length; from > 0 && !svg_is_blank(text[from - 1]) && text[from - 1] != '>';)
        from--;
    if (from == length || !matches_simple(element, text + from, length - from))
        return FAILS;
    while (from > 0 && svg_is_blank(text[from - 1]))
        from--;
    if (from == 0)
        return MATCHES;
    bool child = text[from - 1] == '>';
    from -= child;
    for (const SvgElement *around = element->parent; around; around = around->parent) {
        Match found = match(around, text, from);
        if (found != FAILS || child)
            return found;
    }
    return FAILS_AROUND;
}

static unsigned weight_of(const char *selector)
{
    unsigned weight = 0;
    for (const char *at = selector; *at; at++) {
        bool begins = at == selector || !is_of_name(at[-1]);
        if (*at == '#')
            weight += WEIGHT_ID;
        else if (*at == '.')
            weight += WEIGHT_CLASS;
        else if (is_of_name(*at) && begins && (at == selector || (at[-1] != '#' && at[-1] != '.')))
            weight += WEIGHT_NAME;
    }
    return weight;
}

/* ---- rules ---- */

static const char *trimmed(SvgTree *tree, const char *from, const char *to)
{
    while (from < to && svg_is_blank(*from))
        from++;
    while (to > from && svg_is_blank(to[-1]))
        to--;
    return arena_copy_text(tree->arena, from, (size_t)(to - from));
}

static void add_rule(SvgTree *tree, const char *selector, const char *property, const char *value)
{
    const char *mark   = strstr(value, "!important");
    const char *end    = mark ? mark : value + strlen(value);
    unsigned    weight = weight_of(selector) + (mark ? WEIGHT_IMPORTANT : 0);
    SvgRule     rule   = {selector, property, trimmed(tree, value, end), weight};
    array_push(tree->arena, &tree->rules, rule);
}

static void add_declarations(SvgTree *tree, const char *selector, const char *from, const char *to)
{
    while (from < to) {
        const char *end = memchr(from, ';', (size_t)(to - from)), *colon;
        end             = end ? end : to;
        colon           = memchr(from, ':', (size_t)(end - from));
        if (colon)
            add_rule(tree, selector, trimmed(tree, from, colon), trimmed(tree, colon + 1, end));
        from = end + 1;
    }
}

/* Comments become blanks. */
static char *without_comments(SvgTree *tree, const Text *text)
{
    char *copy = arena_copy_text(tree->arena, text->bytes, text->length);
    for (char *at = copy; (at = strstr(at, "/*"));) {
        char *end = strstr(at + 2, "*/");
        end       = end ? end + 2 : at + strlen(at);
        memset(at, ' ', (size_t)(end - at));
    }
    return copy;
}

/* Returns what is behind the `}` that belongs to the `{` at `text`. */
static const char *behind_block(const char *text)
{
    int open = 0;
    for (; *text; text++) {
        open += *text == '{' ? 1 : *text == '}' ? -1 : 0;
        if (open == 0)
            return text + 1;
    }
    return text;
}

static bool is_known(const char *selector)
{
    for (const char *at = selector; *at; at++)
        if (!is_of_name(*at) && !svg_is_blank(*at) && !strchr(".#*>", *at))
            return false;
    return *selector != '\0';
}

void svg_rules_read(SvgTree *tree, const SvgElement *style)
{
    if (style->text.length == 0)
        return;
    const char *text = without_comments(tree, &style->text);
    for (const char *open; (open = strchr(text, '{')); text = behind_block(open)) {
        const char *close = behind_block(open) - 1;
        for (const char *from = text; from < open;) {
            const char *comma    = memchr(from, ',', (size_t)(open - from));
            comma                = comma ? comma : open;
            const char *selector = trimmed(tree, from, comma);
            if (is_known(selector))
                add_declarations(tree, selector, open + 1, close);
            else if (tree->unknown_rules == 0)
                tree->unknown_rules = style->line;
            from = comma + 1;
        }
    }
}

/* ---- properties ---- */

/* Returns "a: b" in "...; a: b; ..."; NULL if there is none. */
static const char *styled(const SvgTree *tree, const char *style, const char *name)
{
    size_t length = strlen(name);
    while (style && *style) {
        while (svg_is_blank(*style) || *style == ';')
            style++;
        const char *colon = style + length, *end = style + strcspn(style, ";");
        bool        named = strncmp(style, name, length) == 0;
        while (named && svg_is_blank(*colon))
            colon++;
        if (named && *colon == ':') {
            for (colon++; svg_is_blank(*colon);)
                colon++;
            while (end > colon && svg_is_blank(end[-1]))
                end--;
            return arena_copy_text(tree->arena, colon, end > colon ? (size_t)(end - colon) : 0);
        }
        style = end;
    }
    return NULL;
}

const char *svg_property(const SvgTree *tree, const SvgElement *element, const char *name)
{
    const SvgRule *best = NULL;
    for (size_t i = 0; i < tree->rules.count; i++) {
        const SvgRule *rule = &tree->rules.items[i];
        if (strcmp(rule->property, name) == 0 && (!best || rule->weight >= best->weight) &&
            match(element, rule->selector, strlen(rule->selector)) == MATCHES)
            best = rule;
    }
    if (best && best->weight >= WEIGHT_IMPORTANT)
        return best->value;
    const char *value = styled(tree, svg_attribute(element, "style"), name);
    return value ? value : best ? best->value : svg_attribute(element, name);
}
