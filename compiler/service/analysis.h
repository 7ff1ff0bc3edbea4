/*
 * analysis.h: documents that are open, what is known of each, and what the files of this folder share.
 */
#ifndef KRS_SERVICE_ANALYSIS_H
#define KRS_SERVICE_ANALYSIS_H

#include "compiler/base/json.h"
#include "compiler/eval/ask.h"
#include "compiler/eval/vocabulary.h"
#include "compiler/front/files.h"
#include "compiler/service/service.h"

/* A text and the files that it uses, read with all their mistakes.  File 0 is the text. */
typedef struct Analysis {
    bool    made;
    Arena   arena, trees, scratch;
    Sources sources;
    Names   names;
    Diags   diags;
    Files   files;
    Loader  loader;
} Analysis;

typedef struct Document {
    char            *path, *uri, *text;
    size_t           length;
    Analysis         analysis; /* made when it is asked for, until a text changes */
    struct Document *next;
} Document;

struct Service {
    ServiceHost     host;
    Document       *documents;
    Document       *neighbours; /* files beside one, until the next question */
    Memory          memory;
    Analysis        probe; /* of a text that is not quite that of a document */
    Arena           arena; /* of what an answer needs, until the next question */
    Arena           values, scratch;
    Json            json; /* the answer */
    const char     *refusal;
    const Document *probed; /* whose text the probe stands for, or NULL */
    const char     *probe_text;
    size_t          probe_length;
};

/* A document and a place in it. */
typedef struct Here {
    Service      *service;
    Document     *document;
    Analysis     *analysis;
    const File   *file;   /* of the document */
    const Source *source; /* its text */
    uint32_t      offset; /* of the position, or where the range begins */
    uint32_t      end;    /* where it ends */
} Here;

/* ---- analysis.c ---- */
Document *find_document(const Service *service, const char *path);
/* Reads a document; what was read stays until a text changes. */
Analysis *analyse(Service *service, Document *document);
/* Reads files in the folder of a path that are not open and have its name in their texts: they may use it. */
Document *find_neighbours(Service *service, const char *path);
void      documents_free(Document **documents);
/* Reads another text in place of that of a document, until the next question. */
Analysis *analyse_instead(Service *service, const Document *document, const char *text,
                          size_t length);
void      analysis_free(Analysis *analysis);

/* Tells whether an offset is in a span, or touches it. */
static inline bool span_has(Span span, uint32_t offset)
{
    return span.start <= offset && offset <= span.end;
}

/* Nodes from the tree of a file to the innermost one at an offset. */
typedef struct Way {
    const Syntax **items;
    size_t         count, capacity;
} Way;
Way find_way(Arena *arena, const Syntax *tree, uint32_t offset);
/* Returns the way to a node; empty: it is not in the tree. */
Way find_way_to(Arena *arena, const Syntax *tree, const Syntax *node);
/* Returns the last node of a kind on a way, or NULL; *index is where it is. */
const Syntax *last_of_kind(const Way *way, SyntaxKind kind, size_t *index);

/* These tell whether a token is a bracket of any kind. */
static inline bool opens_bracket(TokenKind kind)
{
    return kind == TOKEN_LEFT_PAREN || kind == TOKEN_LEFT_BRACKET || kind == TOKEN_LEFT_BRACE;
}
static inline bool closes_bracket(TokenKind kind)
{
    return kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET || kind == TOKEN_RIGHT_BRACE;
}
/* Returns the number of the token at an offset, or else of the one before it. */
size_t find_token(const Tokens *tokens, uint32_t offset);
/* Returns the word, number or string at an offset, or just before it; or else what is there; NULL:
   nothing touches it. */
const Token *find_pointed(const Tokens *tokens, uint32_t offset);

/* The meaning of a name. */
typedef struct Meaning {
    const Syntax      *syntax; /* the node that defines it; or NULL */
    const BuiltinWord *word;   /* of a name that is built in; or NULL */
} Meaning;
/* Finds the meaning of a name; false: nothing is called so there. */
bool find_meaning(const Analysis *analysis, const char *name, uint32_t offset, Meaning *meaning);
/* Returns the use at an offset, or NULL. */
const NameUse *find_use(const File *file, uint32_t offset);
/* Finds what is built in and called so, a method or not; NULL: nothing. */
const BuiltinWord *find_word(const char *name, bool method);
bool               is_method(const BuiltinWord *word);
bool               is_called(const BuiltinWord *word);
const File        *file_of(const Analysis *analysis, uint32_t source);
/* Tells whether a statement of a file could not be read. */
bool has_unread(const Analysis *analysis, const File *file);

/* A value, and what it was asked of. */
typedef struct Asked {
    Asking *asking;
    Value   value;
} Asked;
/* Returns how many mistakes the statements of another text in place of the document's have. */
size_t mistakes_instead(const Here *here, const char *text, size_t length);
/* Returns the value of the last node of a way in the file. */
Asked value_on(const Here *here, const Way *way);
/* Returns the value of a definition anywhere in the files. */
Asked value_of(const Here *here, const Syntax *definition);

/* ---- signature.c ---- */
/* A call that is being written. */
typedef struct CallHere {
    const Token *callee;
    bool         method;   /* it stands behind a dot */
    uint32_t     argument; /* the number of the argument at the offset, */
    const Token *label;    /* and its name, or NULL */
} CallHere;
bool find_call(const Tokens *tokens, uint32_t offset, CallHere *call);
/* The signature of a function, whose parameters are these bytes of it. */
typedef struct Signature {
    Text        label;
    const char *doc;
    struct Part {
        const char *name;
        uint32_t    start, end;
    } * items;
    size_t count, capacity;
} Signature;
bool find_signature(const Here *here, const CallHere *call, Signature *signature);
/* Makes "torus(major = 1, minor = 0.25)", of a function of the text, or "min(values...)".  The
   label has an arena. */
void signature_of_function(const Analysis *analysis, const Syntax *function, Signature *signature);
void signature_of_word(const BuiltinWord *word, Signature *signature);

/* ---- JSON ---- */
/* Returns the URI of a document or file, or its path if the host knows none. */
const char *uri_of(Service *service, const char *path);
/* Returns the path of a source, which is its name; of the library it begins with "library:". */
const char *path_of(Service *service, const Source *source);
/* Adds the place of a span: {"uri", "range"}. */
void add_location(Service *service, Json *json, const char *name, const Source *source, Span span);

/* ---- tokens.c ---- */
void add_token_legend(Json *json, const char *name);

/* ---- a function for each question: questions.def ---- */
typedef void Answer(const Here *here, const ServiceQuestion *about, Json *json);
#define QUESTION(name, function, capability, value) Answer function;
#include "compiler/service/questions.def"

/* Refuses a question with a reason. */
void refuse_question(const Here *here, const char *reason);

#endif
