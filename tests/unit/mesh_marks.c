/* mesh_marks.c: marks against single cells; and when a mesh is done, all proofs that were kept are found again. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/scene/program.h"
#include "mesh/proof/bounds.h"
#include "mesh/rounds.h"
#include "tests/support/random.h"

static Random chance = {11};

static uint16_t random_cell(void) { return (uint16_t)random_between(&chance, 0, MARKS - 0.01); }

static MarkBox random_box(void)
{
    MarkBox box;
    for (int k = 0; k < 3; k++) {
        uint16_t a = random_cell(), size = (uint16_t)random_between(&chance, 0, k == 2 ? 150 : 20);
        box.low[k]  = a;
        box.high[k] = a + size < MARKS ? (uint16_t)(a + size) : MARKS - 1;
    }
    return box;
}

static bool boxes_meet(const MarkBox *a, const MarkBox *b)
{
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k])
            return false;
    return true;
}

static void marks_touch_what_is_set(void **context)
{
    enum { TIMES = 40, SET = 60, ASKED = 200 };
    Marks *marks = calloc(1, sizeof *marks);
    int    found = 0;
    (void)context;
    for (int i = 0; i < TIMES; i++) {
        MarkBox set[SET], none = mark_box_none();
        for (int k = 0; k < SET; k++) {
            set[k] = random_box();
            marks_set(marks, &set[k]);
        }
        for (int k = 0; k < ASKED; k++) {
            MarkBox box      = random_box();
            bool    expected = false;
            for (int j = 0; j < SET; j++)
                expected = expected || boxes_meet(&set[j], &box);
            assert_int_equal(marks_touch(marks, &box), expected);
            found += expected;
        }
        assert_false(marks_touch(marks, &none));
        marks_clear(marks);
    }
    assert_true(found > TIMES && found < TIMES * (ASKED - 1));
    free(marks);
}

/* ---- proofs ---- */

static Mesher *open_mesher(const char *text, double error, KrsMeshOptions *options,
                           MeshSolid *solid, KrsScene **scene)
{
    KrsState *state;
    Mesher   *m = calloc(1, sizeof *m);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, scene), KRS_OK);
    assert_int_equal(krs_state_new(*scene, &state), KRS_OK);
    solid->roots = malloc(solid_root_bytes(*scene));
    solid_of_components(*scene, NULL, solid);
    *options       = (KrsMeshOptions){.error = error};
    m->options     = options;
    m->solid       = solid;
    m->memory      = (*scene)->memory;
    m->memory.used = 0, m->memory.limit = (size_t)1 << 30;
    m->arena.memory = &m->memory;
    m->error        = error;
    for (int k = 0; k < 3; k++) {
        m->low[k]  = solid->box.axis[k].low;
        m->high[k] = solid->box.axis[k].high;
        m->side    = fmax(m->side, 1.1 * (m->high[k] - m->low[k]) + 4 * error);
    }
    for (size_t i = 0; i < parallel_parts(); i++) {
        m->fields[i] = (MeshField){.solid = solid};
        assert_int_equal(state_copy_of(state, &m->fields[i].state), KRS_OK);
        state_refresh_points(m->fields[i].state);
        field_open(&m->fields[i], &m->arena);
    }
    krs_state_free(state);
    return m;
}

static void close_mesher(Mesher *m, MeshSolid *solid, KrsScene *scene)
{
    for (size_t i = 0; i < parallel_parts(); i++)
        state_free(m->fields[i].state);
    arena_free(&m->arena);
    free(m);
    free(solid->roots);
    krs_scene_free(scene);
}

/* Each with the whole mesh, as if nothing were known of it. */
static void check_proofs(Mesher *m)
{
    Bvh      bvh;
    Verifier verifier = {
        .field = &m->fields[0], .tets = &m->tets, .mesh = &bvh, .error = proven_error(m)};
    size_t unresolved = 0, proven = 0;
    bvh_new(&bvh, (const double(*)[3])m->contour.vertices.items,
            (const uint32_t(*)[3])m->contour.triangles.items, m->contour.triangles.count,
            &m->arena);
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet tet = m->tets.list.items[i];
        assert_true(tet.state == TET_EMPTY || tet.state == TET_PROVEN ||
                    tet.state == TET_UNRESOLVED);
        if (tet.state == TET_EMPTY)
            continue;
        tet.state = (uint8_t)state_by_bounds(m, &tet);
        tet.state = (uint8_t)verify_tet(&verifier, &tet);
        assert_int_not_equal(tet.state, TET_REFUTED);
        unresolved += tet.state == TET_UNRESOLVED;
        proven += tet.state == TET_PROVEN;
    }
    assert_int_equal(unresolved, m->unresolved);
    assert_true(proven > 100);
}

static void kept_proofs_are_found_again(void **context)
{
    static const struct {
        const char *text;
        double      error;
    } scenes[] = {
        {"let k = tau; show field(sin(k * x) * cos(k * y) + sin(k * y) * cos(k * z) + sin(k * z) * "
         "cos(k * x)) & box([1, 1, 1]);",
         0.08},
        {"show difference(box([2, 1, 1]).round(0.1), sphere(0.6), cylinder(0.2, 3));", 0.05},
        {"show union(box([1, 1, 1]).rotate([1, 2, 3], 40deg), torus(0.8, 0.05));", 0.05},
    };
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        KrsMeshOptions options;
        MeshSolid      solid = {0};
        KrsScene      *scene;
        Mesher        *m = open_mesher(scenes[i].text, scenes[i].error, &options, &solid, &scene);
        assert_true(find_proven_mesh(m));
        check_proofs(m);
        close_mesher(m, &solid, scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_touch_what_is_set),
        cmocka_unit_test(kept_proofs_are_found_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
