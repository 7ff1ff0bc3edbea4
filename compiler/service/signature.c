/*
 * signature.c: the call that is being written, and the parameters of what it calls.
 */
#include <string.h>

#include "compiler/service/analysis.h"

/* ---- the call ---- */

/* Goes back from the offset to the bracket that is open there, past those that are closed. */
bool find_call(const Tokens *tokens, uint32_t offset, CallHere *call)
{
    size_t depth = 0;
    bool   first = true; /* no comma was met */
    *call        = (CallHere){0};
    for (size_t i = tokens->count; i-- > 0;) {
        const Token *token = &tokens->items[i];
        if (token->span.end > offset || token->kind == TOKEN_END)
            continue;
        if (closes_bracket(token->kind))
            depth++;
        else if (opens_bracket(token->kind) && depth > 0)
            depth--;
        else if (opens_bracket(token->kind)) {
            const Token *callee = i > 0 ? token - 1 : NULL;
            call->callee        = callee;
            call->method        = i > 1 && callee[-1].kind == TOKEN_DOT;
            const bool defined  = i > 1 &&
                                 (callee[-1].kind == TOKEN_DEF || callee[-1].kind == TOKEN_SHAPE ||
                                  callee[-1].kind == TOKEN_MATERIAL);
            return token->kind == TOKEN_LEFT_PAREN && callee && callee->kind == TOKEN_NAME &&
                   !defined;
        } else if (depth == 0 && token->kind == TOKEN_COMMA) {
            call->argument++;
            first = false;
        } else if (depth == 0 && token->kind == TOKEN_SEMICOLON)
            return false;
        else if (depth == 0 && first && token->kind == TOKEN_COLON && i > 0)
            call->label = token - 1;
    }
    return false;
}

/* ---- what is called ---- */

bool find_signature(const Here *here, const CallHere *call, Signature *signature)
{
    Meaning meaning;
    *signature = (Signature){.label = {.arena = &here->service->arena}};
    if (call->method) {
        const BuiltinWord *word = find_word(call->callee->name, true);
        if (word)
            signature_of_word(word, signature);
        return word != NULL;
    }
    if (!find_meaning(here->analysis, call->callee->name, call->callee->span.start, &meaning))
        return false;
    if (!meaning.syntax)
        signature_of_word(meaning.word, signature);
    else if (syntax_is_function(meaning.syntax))
        signature_of_function(here->analysis, meaning.syntax, signature);
    else
        return false;
    return true;
}

/* Returns the parameter that the argument at the position is for. */
static uint32_t active_parameter(const Signature *signature, const CallHere *call)
{
    for (size_t i = 0; call->label && i < signature->count; i++)
        if (strcmp(signature->items[i].name, call->label->name) == 0)
            return (uint32_t)i;
    return call->argument;
}

void answer_signature(const Here *here, const ServiceQuestion *about, Json *json)
{
    const Tokens tokens = here->file->tokens;
    CallHere     call;
    Signature    signature;
    (void)about;
    if (!find_call(&tokens, here->offset, &call) || !find_signature(here, &call, &signature)) {
        json_text(json, NULL, NULL);
        return;
    }
    const char *label = signature.label.bytes;
    json_open(json, NULL, "{");
    json_open(json, "signatures", "[");
    json_open(json, NULL, "{");
    json_text(json, "label", label);
    if (signature.doc)
        json_text(json, "documentation", signature.doc);
    json_open(json, "parameters", "[");
    for (size_t i = 0; i < signature.count; i++) {
        json_open(json, NULL, "{");
        json_open(json, "label", "[");
        json_whole(json, NULL, utf16_units(label, 0, signature.items[i].start));
        json_whole(json, NULL, utf16_units(label, 0, signature.items[i].end));
        json_close(json, "]");
        json_close(json, "}");
    }
    json_close(json, "]");
    json_close(json, "}");
    json_close(json, "]");
    json_whole(json, "activeSignature", 0);
    json_whole(json, "activeParameter", active_parameter(&signature, &call));
    json_close(json, "}");
}
