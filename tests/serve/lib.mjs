// lib.mjs - starts facet serve and speaks with it, for the tests of this folder.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, symlinkSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import path from 'node:path';

export const [facet, work] = process.argv.slice(2);
export const root = path.join(work, 'root');

// A glTF file of one triangle. more: further members.
export function triangle(more = {}) {
    const positions = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
    return JSON.stringify({
        asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
        accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] }],
        bufferViews: [{ buffer: 0, byteLength: 36 }],
        buffers: [{ byteLength: 36, uri: `data:application/octet-stream;base64,${positions.toString('base64')}` }],
        ...more,
    });
}

// ROOT with models, and files and links that lead out of it.
export function make_root() {
    mkdirSync(path.join(root, 'sub'), { recursive: true });
    writeFileSync(path.join(root, 'tri.gltf'), triangle());
    writeFileSync(path.join(root, 'sub/b.gltf'), triangle());
    writeFileSync(path.join(root, 'broken.glb'), 'no model at all');
    writeFileSync(path.join(root, 'future.gltf'), triangle({ extensionsRequired: ['EXT_unknown'], extensionsUsed: ['EXT_unknown'] }));
    writeFileSync(path.join(root, 'outer.gltf'), triangle({ buffers: [{ byteLength: 36, uri: '../secret.bin' }] }));
    writeFileSync(path.join(root, 'linked.gltf'), triangle({ buffers: [{ byteLength: 36, uri: 'secret.bin' }] }));
    writeFileSync(path.join(work, 'secret.gltf'), triangle());
    writeFileSync(path.join(work, 'secret.bin'), Buffer.alloc(36));
    symlinkSync('../secret.gltf', path.join(root, 'link.gltf'));
    symlinkSync('../secret.bin', path.join(root, 'secret.bin'));
    symlinkSync('..', path.join(root, 'up'));
}

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Until condition() holds; fails after a minute, as machines may be busy.
export async function wait_for(what, condition) {
    for (const end = Date.now() + 60000; Date.now() < end; await sleep(5)) {
        const value = await condition();
        if (value) return value;
    }
    assert.fail(`waited in vain for ${what}`);
}

// What still runs when a test has failed.
const children = new Set();
process.on('exit', () => { for (const child of children) child.kill('SIGKILL'); });

// facet serve with options: its process, what it said on standard error, and its end.
export function start(...options) {
    const child = spawn(facet, ['serve', '--root', root, ...options], { cwd: work });
    const server = { child, log: '' };
    children.add(child);
    child.on('close', () => children.delete(child));
    child.stderr.on('data', (text) => { server.log += text; });
    child.stdin.on('error', () => {});
    server.ended = new Promise((resolve) => child.on('close', (code, signal) => resolve(signal ?? code)));
    return server;
}

// JSON-RPC over two streams: call() gives the response, whatever it is.
export function rpc(input, output) {
    const waiting = new Map(), client = { lines: [], last: 0 };
    let rest = '';
    output.setEncoding('utf8');
    output.on('data', (text) => {
        const lines = (rest + text).split('\n');
        rest = lines.pop();
        for (const line of lines) {
            const message = JSON.parse(line);
            assert(Array.isArray(message) || message.jsonrpc === '2.0');
            client.lines.push(message);
            waiting.get(message.id)?.(message);
        }
    });
    client.write = (text) => input.write(text);
    client.send = (method, params, id) => input.write(`${JSON.stringify({ jsonrpc: '2.0', id, method, params })}\n`);
    client.answer = (id) => new Promise((resolve) => waiting.set(id, resolve));
    client.call = (method, params) => {
        const id = ++client.last, answer = client.answer(id);
        client.send(method, params, id);
        return answer;
    };
    client.next = async () => {
        const count = client.lines.length;
        await wait_for('a line', () => client.lines.length > count);
        return client.lines[count];
    };
    return client;
}

export async function start_stdio(...options) {
    const server = start('--stdio', ...options);
    server.client = rpc(server.child.stdin, server.child.stdout);
    return server;
}

// The end of a server whose standard input closes.
export async function stop_stdio(server, code = 0) {
    server.child.stdin.end();
    assert.equal(await server.ended, code, server.log);
}

export function connect(file) {
    return new Promise((resolve, reject) => {
        const socket = net.createConnection(file, () => resolve(socket));
        socket.on('error', reject);
    });
}

export const png_size = (bytes) => {
    assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
    return [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
};

// An image that takes minutes.
export const slow = { model: 'tri.gltf', size: '2048', renderer: 'path', samples: 1000000, orbit: '0,75,20%' };

// Runs tests in turn; one that takes longer than two minutes fails.
export async function run(tests) {
    make_root();
    for (const [name, test] of Object.entries(tests)) {
        const timer = setTimeout(() => { console.error(`FAILED: ${name}: it takes too long`); process.exit(1); }, 120000);
        try {
            await test();
        } catch (error) {
            console.error(`FAILED: ${name}`);
            console.error(error);
            process.exit(1);
        }
        clearTimeout(timer);
    }
    console.log(`${Object.keys(tests).length} tests: all as expected`);
    process.exit(0);
}
