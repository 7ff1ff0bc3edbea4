/*
 * svg_tree.c: reads the XML of a drawing, by expat.
 */
#include "compiler/outline/svg_tree.h"

#include <expat.h>
#include <stdint.h>
#include <string.h>

enum { MAX_DEPTH = 256 };

typedef struct Reader {
    SvgTree    *tree;
    XML_Parser  parser;
    SvgElement *open;
    int         depth;
} Reader;

/* ---- memory ---- */

/* expat has memory of the arena, which is freed with it: also where it runs out, and the call of expat
   does not return. */
static _Thread_local Arena *expat_arena;

typedef struct Block {
    size_t size;
    _Alignas(max_align_t) char bytes[];
} Block;

static void *get_block(size_t size)
{
    Block *block = arena_alloc(expat_arena, 1, sizeof *block + size);
    block->size  = size;
    return block->bytes;
}

static void *resize_block(void *old, size_t size)
{
    void *fresh = get_block(size);
    if (old) {
        size_t had = ((Block *)((char *)old - offsetof(Block, bytes)))->size;
        memcpy(fresh, old, had < size ? had : size);
    }
    return fresh;
}

static void drop_block(void *block) { (void)block; }

static unsigned line_of(XML_Parser parser)
{
#if XML_MAJOR_VERSION * 100 + XML_MINOR_VERSION >= 209
    return (unsigned)XML_GetCurrentLineNumber64(parser);
#else
    return (unsigned)XML_GetCurrentLineNumber(parser);
#endif
}

/* ---- elements ---- */

static void stop(Reader *reader, const char *fault)
{
    reader->tree->fault = fault;
    XML_StopParser(reader->parser, XML_FALSE);
}

static const char *copy(Reader *reader, const char *text)
{
    return arena_copy_text(reader->tree->arena, text, strlen(text));
}

static const char *const *copy_attributes(Reader *reader, const char **attributes)
{
    size_t count = 0;
    while (attributes[count])
        count++;
    const char **copies = arena_new_array(reader->tree->arena, const char *, count + 1);
    for (size_t i = 0; i < count; i++)
        copies[i] = copy(reader, attributes[i]);
    copies[count] = NULL;
    return copies;
}

/* Returns "path" of "svg:path", where names have prefixes; others belong to editors. */
static const char *local_name(const char *name)
{
    return strncmp(name, "svg:", 4) == 0 ? name + 4 : name;
}

static void begin_element(void *user, const char *name, const char **attributes)
{
    Reader *reader = user;
    if (++reader->depth >= MAX_DEPTH) {
        stop(reader, "elements are nested too deep");
        return;
    }
    SvgElement *element = arena_new(reader->tree->arena, SvgElement);
    *element            = (SvgElement){.name       = copy(reader, local_name(name)),
                                       .attributes = copy_attributes(reader, attributes),
                                       .text       = {.arena = reader->tree->arena},
                                       .line       = line_of(reader->parser),
                                       .parent     = reader->open};
    if (!reader->open)
        reader->tree->root = element;
    else if (reader->open->last)
        reader->open->last->next = element;
    else
        reader->open->first = element;
    if (reader->open)
        reader->open->last = element;
    reader->open = element;
    if (!element->parent && strcmp(element->name, "svg") != 0)
        stop(reader, "this is no SVG: its first element is not `svg`");
}

static void end_element(void *user, const char *name)
{
    Reader *reader = user;
    (void)name;
    if (strcmp(reader->open->name, "style") == 0)
        svg_rules_read(reader->tree, reader->open);
    reader->open = reader->open->parent;
    reader->depth--;
}

static void add_text(void *user, const char *bytes, int length)
{
    Reader *reader = user;
    if (reader->open && strcmp(reader->open->name, "style") == 0)
        text_add_bytes(&reader->open->text, bytes, (size_t)length);
}

/* The words of expat change with its version. */
static const char *xml_fault(XML_Parser parser)
{
    switch (XML_GetErrorCode(parser)) {
    case XML_ERROR_NONE: return "it is too long";
    case XML_ERROR_NO_ELEMENTS:
    case XML_ERROR_UNCLOSED_TOKEN:
    case XML_ERROR_UNCLOSED_CDATA_SECTION:
    case XML_ERROR_PARTIAL_CHAR: return "it ends too early";
    case XML_ERROR_TAG_MISMATCH: return "an element is closed by the name of another";
    case XML_ERROR_DUPLICATE_ATTRIBUTE: return "an element has an attribute twice";
    case XML_ERROR_JUNK_AFTER_DOC_ELEMENT: return "there is something behind its last element";
    case XML_ERROR_UNDEFINED_ENTITY: return "an entity (`&name;`) is not declared";
    case XML_ERROR_UNKNOWN_ENCODING:
    case XML_ERROR_INCORRECT_ENCODING: return "its encoding is not known";
    default: return "this is not XML";
    }
}

bool svg_tree_read(SvgTree *tree, const char *bytes, size_t length)
{
    static const XML_Memory_Handling_Suite memory = {get_block, resize_block, drop_block};
    expat_arena                                   = tree->arena;
    Reader reader = {.tree = tree, .parser = XML_ParserCreate_MM(NULL, &memory, NULL)};
    XML_SetUserData(reader.parser, &reader);
    XML_SetElementHandler(reader.parser, begin_element, end_element);
    XML_SetCharacterDataHandler(reader.parser, add_text);
    bool good = length <= INT32_MAX &&
                XML_Parse(reader.parser, bytes, (int)length, XML_TRUE) == XML_STATUS_OK;
    if (!good) {
        tree->fault      = tree->fault ? tree->fault : xml_fault(reader.parser);
        tree->fault_line = line_of(reader.parser);
    }
    XML_ParserFree(reader.parser);
    return good;
}

/* ---- what is asked ---- */

const char *svg_attribute(const SvgElement *element, const char *name)
{
    for (const char *const *at = element->attributes; *at; at += 2)
        if (strcmp(at[0], name) == 0)
            return at[1];
    return NULL;
}

static const SvgElement *with_id(const SvgElement *element, const char *id, size_t length)
{
    const char *own = svg_attribute(element, "id");
    if (own && strlen(own) == length && strncmp(own, id, length) == 0)
        return element;
    for (const SvgElement *child = element->first; child; child = child->next) {
        const SvgElement *found = with_id(child, id, length);
        if (found)
            return found;
    }
    return NULL;
}

const SvgElement *svg_referred(const SvgTree *tree, const char *reference)
{
    const char *id = reference ? strchr(reference, '#') : NULL;
    return id ? with_id(tree->root, id + 1, strcspn(id + 1, ")\"' \t\r\n")) : NULL;
}
