// gl.mjs - the renderer's own tests, compiled by tests/web/gl, in headless Chromium: desktop drivers let pass what browsers refuse.
// usage: gl.mjs BUILD PARITY [PROGRAM...]: with programs, these only, and all that they write
import assert from 'node:assert/strict';
import path from 'node:path';
import { serve_page } from '../clients/browser.mjs';

const [build, parity, ...chosen] = process.argv.slice(2);
const FEWEST = 200; // tests that pass

// Tests that cannot run in a browser, by their reason. One that does not exist is an error.
const excluded = {
    'compares with the preview, which needs Embree': [
        'gl_material.alpha_modes_match_the_preview', 'gl_material.energy_conservation_matches_the_preview',
        'gl_material.every_extension_matches_the_preview', 'gl_material.every_texture_slot_matches_the_preview',
        'gl_material.shared_texels_are_sampled_once', 'gl_material.texture_coordinates_match_the_preview',
        'gl_material.transformed_vectors_match_the_preview',
        'gl_mesh.deformed_vertices_are_streamed', 'gl_mesh.high_texture_coordinate_sets_are_read',
        'gl_mesh.lines_with_normals_are_lit', 'gl_mesh.mirrored_instances_are_culled_correctly',
        'gl_mesh.sprites_are_a_pixel_wide', 'gl_phong.every_texture_type_and_mode_matches_the_preview',
        'gl_phong.layers_blend_in_display_values', 'gl_phong.maps_of_every_term_match_the_preview',
        'gl_phong.punctual_lights_colors_and_sprites_match_the_preview', 'gl_phong.spheres_match_the_preview_in_every_variant',
        'gl_renderer.aovs_match_the_preview', 'gl_renderer.images_match_the_preview', 'gl_renderer.more_samples_reduce_the_error',
        'gl_scene.frames_match_fresh_renderers', 'gl_transparency.blended_spheres_match_the_preview',
        'gl_transparency.blended_sprites_match_the_preview', 'gl_transparency.crossed_surfaces_are_peeled',
        'gl_transparency.mask_edges_are_antialiased',
    ],
    'models in a sea need Embree': [
        'gl_sea.models', 'gl_sea.models_far_from_each_other', 'gl_sea.a_model_with_many_textures', 'gl_sea.a_hull_in_waves',
        'gl_sea.a_model_in_the_legacy_style', 'gl_sea.a_model_from_below_in_opengl_es',
    ],
    'takes long with SwiftShader; opengl_es_draws_what_the_preview_does has the same shaders': [
        'gl_sea.opengl_draws_what_the_preview_does', 'gl_sea.still_and_shallow_water', 'gl_sea.parts_and_depths', 'gl_sea.other_facets',
        'gl_sea.environments',
    ],
    'takes long with SwiftShader; the other tests of gl_opaque have the same programs': [
        'gl_opaque.white_glass_passes_the_furnace_test', 'gl_opaque.roughness_blurs_and_preserves_the_mean',
        'gl_opaque.a_slab_shifts_rays_by_snells_law',
    ],
    'there are no threads': [
        'gl_renderer_life.any_thread_can_draw',
    ],
    'the page has one context, which is always current: gl_context_web loses it and makes another': [
        'gl_renderer_life.a_lost_context_is_replaced', 'gl_renderer_life.both_codes_of_a_lost_context_count',
        'gl_renderer_life.the_callers_context_is_restored', 'gl_sea.a_context_that_cannot_be_current_leaves_no_memory',
    ],
    'starts a process': [
        'gl_program.glslang_accepts_every_configuration',
    ],
};
const reasons = new Map(Object.entries(excluded).flatMap(([reason, names]) => names.map((name) => [name, reason])));

const html = `<!doctype html><html lang="en"><meta charset="utf-8"><title>tests</title><link rel="icon" href="data:,"><body><script type="module">
import createTests from './gl_tests.js';
window.lines = [];
window.start = async (excluded) => {
    const print = (line) => window.lines.push(line);
    const module = window.module = await createTests({ print, printErr: print, isExcluded: (name) => excluded.includes(name) });
    module.FS.writeFile('/parity.glsl', await (await fetch('parity.glsl')).text());
    return Array.from({ length: module._gl_tests_count() }, (_, index) => module.UTF8ToString(module._gl_tests_name(index)));
};
// The lines that the program wrote, and how it ended.
window.run = (index) => {
    window.lines = [];
    try {
        return { failures: window.module._gl_tests_run(index), lines: window.lines };
    } catch (error) {
        return { failures: 1, lines: [...window.lines, 'FAILED program.' + index + ': ' + (error.stack ?? error)] };
    }
};
</script></body></html>`;

const served = await serve_page('/test.html', (url) => {
    if (url === '/test.html') return { text: html };
    return url === '/parity.glsl' ? parity : path.join(build, url);
});
const { page, messages } = served;
const counts = { passed: 0, FAILED: 0, skipped: 0, excluded: 0 };
const problems = [];

// A line of shim/cmocka.h, or a case of tests/parity.
function count(line) {
    const [, result, name, message] = line.match(/^(passed|FAILED|skipped|excluded) ([\w.]+): (.*)$/) ?? [];
    const parity_case = line.match(/^\w+\.h, \w+: largest relative difference /);
    if (parity_case) counts[line.includes('TOO LARGE') ? 'FAILED' : 'passed']++;
    if (result) counts[result]++;
    if (result === 'excluded') reasons.delete(name);
    if (result === 'FAILED' || result === 'skipped' || line.includes('TOO LARGE')) problems.push(line);
    if (chosen.length) console.log(line);
    return Boolean(result || parity_case);
}

try {
    const programs = await page.evaluate((names) => window.start(names), [...reasons.keys()]);
    assert.ok(programs.length >= 20, `the module has ${programs.length} programs only`);
    for (const [index, name] of programs.entries()) {
        if (chosen.length && !chosen.includes(name)) continue;
        const started = Date.now(), before = problems.length;
        const { failures, lines } = await page.evaluate((i) => window.run(i), index);
        await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 100)));
        const others = lines.filter((line) => !count(line));
        if (failures && problems.length === before) problems.push(`${name} failed: ${others.join(' / ')}`);
        if (chosen.length) console.log([...others, ...messages.splice(0)].join('\n'));
        console.log(`${name}: ${((Date.now() - started) / 1000).toFixed(1)} s`);
    }
} finally {
    await served.close();
}
console.log(`gl: ${counts.passed} passed, ${counts.FAILED} failed, ${counts.excluded} excluded, ${counts.skipped} skipped`);
problems.push(...[...reasons.keys()].map((name) => `${name} is excluded, but there is no such test`));
assert.deepEqual(problems, []);
assert.ok(counts.passed >= FEWEST, `${counts.passed} tests passed, fewer than ${FEWEST}`);
