/*
 * fold.c: operations on numbers that are known when the scene is compiled, which make no node.
 *
 * A number that the author may change without another program has an identity.  So has what is
 * computed from it: it is one number for the shaders, however long the formula.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

bool value_is_authored(Value value)
{
    for (size_t i = 0; value.type == VALUE_LIST && i < value.list->count; i++)
        if (value.list->items[i].number_id)
            return true;
    return value.type == VALUE_NUMBER && value.number_id;
}

Value value_authored(Elaboration *e, Value value)
{
    if (e->parameterises && value.type == VALUE_NUMBER)
        value.number_id = ++e->number_count;
    return value;
}

/* ---- identities of what is computed ---- */

/* An operation, the number of elements of each argument, and which of them have identities; then
   these, and of other numbers the bits. */
typedef struct DerivationKey {
    uint64_t words[1 + 4 * MAX_OPERANDS];
    uint32_t count, latest; /* of the words; of the identities */
} DerivationKey;

/* The numbers computed so far: the same operation on the same numbers gives the same number, as
   equal nodes are one node. */
struct Derivations {
    struct {
        uint64_t *items; /* keys, each with the identity of the first number that it gave */
        size_t    count, capacity;
    } words;
    NearSlots slots; /* of their first words */
    size_t    count;
};

static void key_add(DerivationKey *key, Value value, uint32_t argument, size_t element)
{
    const double number = value.type == VALUE_BOOLEAN ? value.boolean : value.number;
    const bool   named  = value.type == VALUE_NUMBER && value.number_id;
    uint64_t     word   = value.number_id;
    if (!named)
        memcpy(&word, &number, sizeof word);
    if (named && value.number_id > key->latest)
        key->latest = value.number_id;
    key->words[key->count++] = word;
    key->words[0] += (uint64_t)1 << (8 + 8 * argument);
    key->words[0] |= (uint64_t)named << (12 + 8 * argument + element);
}

/* Lists have 4 elements at most. */
static DerivationKey key_of(Op op, const Value *arguments, uint32_t count)
{
    DerivationKey key;
    key.words[0] = op;
    key.count    = 1;
    key.latest   = 0;
    for (uint32_t i = 0; i < count; i++) {
        const List *list = arguments[i].type == VALUE_LIST ? arguments[i].list : NULL;
        for (size_t k = 0; k < (list ? list->count : 1); k++)
            key_add(&key, list ? list->items[k] : arguments[i], i, k);
    }
    return key;
}

static uint32_t key_hash(const DerivationKey *key)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < key->count; i++) {
        hash = (hash ^ key->words[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return (uint32_t)(hash >> 16);
}

static bool is_key(const uint64_t *words, const DerivationKey *key)
{
    return words[0] == key->words[0] && !memcmp(words, key->words, key->count * sizeof *words);
}

/* Returns the slot of an equal key, or the free one where it belongs. */
static NearSlot *find_slot(const struct Derivations *all, const DerivationKey *key, uint32_t hash)
{
    for (size_t steps = 0;; steps++) {
        NearSlot *at = near_slot(&all->slots, key->latest, hash, steps);
        if (!at->number || (at->hash == hash && is_key(&all->words.items[at->number - 1], key)))
            return at;
    }
}

/* Returns the latest identity in a key that is kept. */
static uint32_t latest_of(const uint64_t *words)
{
    uint64_t        latest = 0;
    const uint64_t *word   = words;
    for (uint32_t i = 0; i < MAX_OPERANDS; i++)
        for (uint32_t k = 0; k < (words[0] >> (8 + 8 * i) & 7); k++) {
            word++;
            if (words[0] >> (12 + 8 * i + k) & 1 && *word > latest)
                latest = *word;
        }
    return (uint32_t)latest;
}

static void grow(struct Derivations *all, Arena *arena)
{
    const NearSlots old = all->slots;
    all->slots.count    = old.count ? SLOTS_GROWTH * old.count : MIN_SLOTS;
    all->slots.items    = arena_new_array(arena, NearSlot, all->slots.count);
    for (size_t i = 0; i < old.count; i++) {
        const NearSlot *slot = &old.items[i];
        if (slot->number)
            *near_slot_free(&all->slots, latest_of(&all->words.items[slot->number - 1]),
                            slot->hash) = *slot;
    }
    arena_release(arena, old.items, old.count * sizeof *old.items);
}

/* Returns the identity of the first of `results` numbers that an operation gives; the others
   follow. */
static uint32_t derive(Elaboration *e, const DerivationKey *key, uint32_t results)
{
    if (!e->derivations)
        e->derivations = arena_new(e->arena, struct Derivations);
    struct Derivations *all = e->derivations;
    if (2 * (all->count + 1) > all->slots.count)
        grow(all, e->arena);
    const uint32_t hash = key_hash(key);
    NearSlot      *slot = find_slot(all, key, hash);
    if (slot->number)
        return (uint32_t)all->words.items[slot->number - 1 + key->count];
    *slot = (NearSlot){hash, (uint32_t)all->words.count + 1};
    for (uint32_t i = 0; i < key->count; i++)
        array_push_large(e->arena, &all->words, key->words[i]);
    array_push_large(e->arena, &all->words, (uint64_t)e->number_count + 1);
    all->count++;
    e->number_count += results;
    return e->number_count + 1 - results;
}

Value value_from(Elaboration *e, Value value, Op op, const Value *arguments, uint32_t count)
{
    bool authored = false;
    for (uint32_t i = 0; i < count; i++)
        authored = authored || (arguments[i].type == VALUE_NUMBER && arguments[i].number_id);
    if (!authored || !e->parameterises || value.type != VALUE_NUMBER)
        return value;
    const DerivationKey key = key_of(op, arguments, count);
    value.number_id         = derive(e, &key, 1);
    return value;
}

/* ---- operations ---- */

bool fold_op(Op op, const Value *arguments, uint32_t count, double *result)
{
    GraphType types[MAX_OPERANDS]    = {0};
    NodeValue operands[MAX_OPERANDS] = {0};
    for (uint32_t i = 0; i < count; i++) {
        if (arguments[i].type != VALUE_NUMBER)
            return false;
        types[i]         = TYPE_FLOAT;
        operands[i].v[0] = arguments[i].number + 0.0; /* -0 and 0 are one constant */
    }
    *result = op_evaluate(op, TYPE_FLOAT, 0, types, operands).v[0];
    return isfinite(*result);
}

/* Returns the number or vector that a value is; 0: it is none that is known now and finite. */
static GraphType known_numbers(Value value, NodeValue *numbers)
{
    if (value.type != VALUE_NUMBER)
        return (GraphType)value_numbers(value, numbers->v);
    numbers->v[0] = value.number + 0.0;
    return isfinite(value.number) ? TYPE_FLOAT : 0;
}

bool fold_vectors(Elaboration *e, Op op, const Value *arguments, uint32_t count, Value *result)
{
    GraphType types[MAX_OPERANDS]    = {0};
    NodeValue operands[MAX_OPERANDS] = {0};
    bool      authored               = false;
    for (uint32_t i = 0; i < count; i++) {
        types[i] = known_numbers(arguments[i], &operands[i]);
        authored = authored || value_is_authored(arguments[i]);
        if (types[i] == 0)
            return false;
    }
    const GraphType type = authored ? graph_op_type(op, types, count) : 0;
    if (type == 0)
        return false;
    const NodeValue value = op_evaluate(op, type, 0, types, operands);
    for (uint32_t i = 0; i < (uint32_t)type; i++)
        if (!isfinite(value.v[i]))
            return false;
    const DerivationKey key   = key_of(op, arguments, count);
    const uint32_t      id    = derive(e, &key, (uint32_t)type);
    Value              *items = arena_new_array(e->values, Value, type);
    for (uint32_t i = 0; i < (uint32_t)type; i++)
        items[i] = (Value){.type = VALUE_NUMBER, .number_id = id + i, .number = value.v[i]};
    *result = type == TYPE_FLOAT ? items[0] : value_list(e, items, type);
    return true;
}
