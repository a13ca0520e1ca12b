// mcp.mjs - facet serve --mcp with the client of the Model Context Protocol's SDK.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { Client } from '@modelcontextprotocol/sdk/client/index.js';
import { StdioClientTransport } from '@modelcontextprotocol/sdk/client/stdio.js';
import { facet, png_size, root, run, slow, start, wait_for, work } from './lib.mjs';

async function connect(...options) {
    const transport = new StdioClientTransport({ command: facet, args: ['serve', '--mcp', '--root', root, ...options], cwd: work,
        env: { TMPDIR: process.env.TMPDIR, PATH: process.env.PATH }, stderr: 'inherit' });
    const client = new Client({ name: 'facet-tests', version: '1.0.0' });
    await client.connect(transport);
    client.tool = (name, args) => client.callTool({ name, arguments: args });
    return client;
}

const image_of = (result) => {
    const { data, mimeType } = result.content.find((c) => c.type === 'image');
    return [mimeType, ...png_size(Buffer.from(data, 'base64'))];
};
const text_of = (result) => result.content.find((c) => c.type === 'text').text;

await run({
    async 'tools have schemas of their options'() {
        const client = await connect();
        assert.equal(client.getServerVersion().name, 'facet');
        const { tools } = await client.listTools();
        assert.deepEqual(tools.map((t) => t.name), ['render', 'inspect', 'compare', 'convert', 'options']);
        const { inputSchema } = tools[0];
        assert.deepEqual(inputSchema.required, ['model']);
        assert.equal(inputSchema.properties['tone-mapping'].enum.includes('agx'), true);
        assert.deepEqual([inputSchema.properties.samples.type, inputSchema.properties.samples.minimum], ['integer', 1]);
        assert.equal(inputSchema.properties.denoise.type, 'boolean');
        assert.equal(inputSchema.properties.json, undefined);
        assert.deepEqual(tools[3].inputSchema.required, ['model', 'output']);
        assert.match(tools[0].inputSchema.properties.size.description, /default: 640x480/);
        assert(JSON.stringify(tools).length < 40000); // it stands in the context of every session
        const options = text_of(await client.tool('options', { tool: 'render' }));
        for (const word of ['orbit ', 'turntable ', 'exposure ']) assert(options.includes(`\n${word}`), word);
        assert.equal((await client.tool('options', { tool: 'x' })).isError, true);
        await client.close();
    },
    async 'images are images'() {
        const client = await connect();
        const rendered = await client.tool('render', { model: 'tri.gltf' });
        assert.deepEqual(image_of(rendered), ['image/png', 640, 480]);
        assert.equal(JSON.parse(text_of(rendered)).exit_code, 0);
        assert.deepEqual(image_of(await client.tool('render', { model: 'tri.gltf', size: '32', orbit: '30,75,105%' })), ['image/png', 32, 32]);
        assert.equal(JSON.parse(text_of(await client.tool('inspect', { model: 'tri.gltf' }))).counts.triangles, 1);
        for (const [name, samples] of [['a.png', 1], ['b.png', 2]])
            assert(!(await client.tool('render', { model: 'tri.gltf', size: '32', samples, output: name })).isError);
        const compared = await client.tool('compare', { a: 'a.png', b: 'b.png' });
        assert.deepEqual(image_of(compared), ['image/png', 32, 32]);
        assert(JSON.parse(text_of(compared)).metrics.flip > 0);
        assert(!(await client.tool('convert', { model: 'tri.gltf', output: 'made.glb' })).isError);
        assert.equal(readFileSync(path.join(root, 'made.glb')).subarray(0, 4).toString(), 'glTF');
        await client.close();
    },
    async 'failures are results that can be read'() {
        const client = await connect();
        for (const [name, args, text] of [
            ['render', { model: '../secret.gltf' }, 'outside'], ['render', { model: 'missing.glb' }, 'No such file'], ['render', {}, 'model is missing'],
            ['render', { model: 'tri.gltf', sise: 1 }, 'did you mean'], ['render', { model: 'tri.gltf', format: 'exr' }, 'without output'],
            ['render', { model: 'tri.gltf', output: '../a.png' }, 'outside'], ['convert', { model: 'tri.gltf' }, 'output'],
        ]) {
            const result = await client.tool(name, args);
            assert.equal(result.isError, true, name);
            assert(text_of(result).includes(text), text_of(result));
        }
        await assert.rejects(client.tool('dance', {}), /no such tool/);
        await client.ping();
        await client.close();
    },
    async 'calls can be cancelled'() {
        const client = await connect('-j', '1'), abort = new AbortController();
        const call = client.callTool({ name: 'render', arguments: slow }, undefined, { signal: abort.signal });
        setTimeout(() => abort.abort(), 300);
        await assert.rejects(call);
        assert.deepEqual(image_of(await client.tool('render', { model: 'tri.gltf', size: '16' })), ['image/png', 16, 16]);
        await client.close();
    },
    async 'versions are agreed on, and the end of input ends it'() {
        const server = start('--mcp');
        let out = '';
        server.child.stdout.on('data', (text) => { out += text; });
        const send = (message) => server.child.stdin.write(`${JSON.stringify({ jsonrpc: '2.0', ...message })}\n`);
        send({ id: 1, method: 'initialize', params: { protocolVersion: '1999-01-01', capabilities: {}, clientInfo: { name: 'x', version: '1' } } });
        send({ method: 'notifications/initialized' });
        send({ id: 2, method: 'resources/list' });
        await wait_for('two answers', () => out.split('\n').length === 3);
        const [first, second] = out.trim().split('\n').map((line) => JSON.parse(line));
        assert.match(first.result.protocolVersion, /^20\d\d-\d\d-\d\d$/);
        assert.equal(second.error.code, -32601);
        server.child.stdin.end();
        assert.equal(await server.ended, 0);
    },
});
