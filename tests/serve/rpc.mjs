// rpc.mjs - JSON-RPC 2.0 on standard input and output, and on a socket.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import path from 'node:path';
import { connect, facet, root, rpc, run, sleep, slow, start, start_stdio, stop_stdio, triangle, wait_for, work, png_size } from './lib.mjs';

const bytes_of = (answer, i = 0) => Buffer.from(answer.result.outputs[i].base64, 'base64');
const small = { model: 'tri.gltf', size: '48x32' };

// A socket server and a client of it.
async function start_socket(name, ...options) {
    const file = path.join(work, name), server = start('--socket', file, ...options);
    await wait_for('the socket', () => server.log.includes('serving at'));
    return { file, server, connect: async () => { const socket = await connect(file); return { socket, ...rpc(socket, socket) }; } };
}

await run({
    async 'methods answer with the object of --json and files'() {
        const server = await start_stdio(), { client } = server;
        const answer = await client.call('render', small);
        assert.deepEqual(png_size(bytes_of(answer)), [48, 32]);
        const { name, media_type, bytes } = answer.result.outputs[0];
        assert.deepEqual([name, media_type, bytes], ['tri.png', 'image/png', bytes_of(answer).length]);
        assert.equal(answer.result.exit_code, 0);
        assert.equal(answer.result.pictures[0].output, 'tri.png');
        // the same bytes as those of the command
        const file = path.join(work, 'same.png');
        execFileSync(facet, ['render', path.join(root, 'tri.gltf'), '-o', file, '--size', '48x32']);
        assert(readFileSync(file).equals(bytes_of(answer)));
        const inspect = await client.call('inspect', { model: 'sub/b.gltf' });
        assert.equal(inspect.result.counts.triangles, 1);
        const converted = await client.call('convert', { model: 'tri.gltf' });
        assert.equal(bytes_of(converted).subarray(0, 4).toString(), 'glTF');
        const parts = await client.call('convert', { model: 'tri.gltf', to: 'gltf' });
        assert.deepEqual(parts.result.outputs.map((f) => path.extname(f.name)).sort(), ['.bin', '.gltf']);
        const sheet = await client.call('render', { ...small, turntable: 3 });
        assert.equal(sheet.result.outputs.length, 3);
        const baked = await client.call('bake', { environment: 'sun:40,135', size: 16, mips: 1, sh: 'sh.json' });
        assert.deepEqual(baked.result.outputs.map((f) => f.name).sort(), ['environment.ktx2', 'sh.json']);
        await stop_stdio(server);
    },
    async 'models come in base64 and results go to files'() {
        const server = await start_stdio(), { client } = server;
        const base64 = Buffer.from(triangle()).toString('base64');
        const plain = await client.call('render', { ...small, model: { base64 } });
        const named = await client.call('render', { ...small, model: { base64, name: 'chair.gltf' } });
        assert.deepEqual(png_size(bytes_of(plain)), [48, 32]);
        assert.equal(named.result.pictures[0].model, 'chair.gltf');
        assert(!JSON.stringify(named.result).includes(process.env.TMPDIR));
        const bin = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer).toString('base64');
        const split = Buffer.from(triangle({ buffers: [{ byteLength: 36, uri: 'data/a.bin' }] })).toString('base64');
        const whole = await client.call('inspect', { model: { base64: split, name: 'a.gltf', files: { 'data/a.bin': bin } } });
        assert.equal(whole.result.counts.triangles, 1);
        const written = await client.call('render', { ...small, output: 'made/a.png' });
        assert.equal(written.result.outputs, undefined);
        assert.deepEqual(png_size(readFileSync(path.join(root, 'made/a.png'))), [48, 32]);
        const same = await client.call('compare', { a: 'made/a.png', b: { base64: plain.result.outputs[0].base64 } });
        assert.equal(same.result.metrics.max, 0);
        const difference = await client.call('compare', { a: 'made/a.png', b: 'made/a.png', 'heat-map': true, max: 'flip=0.1' });
        assert.deepEqual(png_size(bytes_of(difference)), [48, 32]);
        await stop_stdio(server);
    },
    async 'errors have codes, exit codes and sentences'() {
        const server = await start_stdio('--max-body', '64K'), { client } = server;
        const cases = [
            ['render', {}, -32602, 2, 'model is missing'],
            ['render', { ...small, sise: 3 }, -32602, 2, 'did you mean --size'],
            ['render', { ...small, size: 'x' }, -32602, 2, '--size'],
            ['render', { ...small, config: 'a.json' }, -32602, 2, 'cannot be given'],
            ['render', { ...small, 'env-cache': '/tmp' }, -32602, 2, 'cannot be given'],
            ['render', { ...small, checkpoint: 'a.exr' }, -32602, 2, 'cannot be given'],
            ['render', { ...small, 'no-clobber': true }, -32602, 2, 'it needs output'],
            ['render', { model: 'sub' }, -32602, 2, 'sub: it is not a file'],
            ['render', { model: { base64: '?' } }, -32602, 2, 'base64'],
            ['render', { model: { base64: 'AAAA', name: '../a' } }, -32602, 2, '../a'],
            ['render', { model: { base64: 'AAAA', files: { '/etc/x': 'AAAA' } } }, -32602, 2, '/etc/x'],
            ['render', { model: { base64: 'A'.repeat(100000) } }, -32007, 7, '--max-body'],
            ['render', { model: 'missing.glb' }, -32003, 3, 'missing.glb: No such file'],
            ['render', { model: 'broken.glb' }, -32004, 4, 'broken.glb'],
            ['render', { model: 'future.gltf' }, -32005, 5, 'EXT_unknown'],
            ['render', { ...slow, 'time-limit': '200ms', size: 4096, output: 'never.pfm' }, -32001, 7, 'time'],
            ['render', { ...small, size: 8192, 'max-memory': '16M' }, -32007, 7, 'memory'],
            ['dance', {}, -32601, 2, 'there is no method'],
        ];
        for (const [method, params, code, exit_code, text] of cases) {
            const { error } = await client.call(method, params);
            assert.deepEqual([error?.code, error?.data.exit_code], [code, exit_code], `${method} ${JSON.stringify(params).slice(0, 80)}: ${JSON.stringify(error)}`);
            assert(error.message.includes(text), error.message);
        }
        assert((await client.call('render', small)).result);
        await stop_stdio(server);
    },
    async 'a closed standard output is no reason to wait'() {
        const line = JSON.stringify({ jsonrpc: '2.0', id: 1, method: 'status' });
        const { status } = spawnSync('sh', ['-c', 'exec "$0" serve --stdio >&-', facet], { input: `${line}\n`, timeout: 30000 });
        assert.equal(status, 0);
    },
    async 'few descriptors are enough for many workers'() {
        const line = `${JSON.stringify({ jsonrpc: '2.0', id: 1, method: 'render', params: { ...small, threads: 1 } })}\n`;
        const { stdout } = spawnSync('sh', ['-c', 'ulimit -n 30; exec "$0" serve --stdio --root "$1" -j 64', facet, root], { input: line, timeout: 30000 });
        assert(JSON.parse(stdout).result, stdout);
    },
    async 'no path leads out of the root'() {
        const server = await start_stdio(), { client } = server;
        const secret = path.join(work, 'secret.gltf');
        for (const model of ['../secret.gltf', secret, 'link.gltf', 'up/secret.gltf', 'sub/../../secret.gltf', '/etc/passwd'])
            assert.equal((await client.call('inspect', { model })).error.code, -32002, model);
        for (const model of ['outer.gltf', 'linked.gltf'])
            assert.match((await client.call('inspect', { model })).error?.message ?? 'read', /leads out/, model);
        for (const output of ['../a.png', path.join(work, 'a.png'), 'up/a.png', 'x/../../a.png'])
            assert.equal((await client.call('render', { ...small, output })).error.code, -32002, output);
        assert((await client.call('convert', { model: 'tri.gltf', output: '...gltf' })).result);
        for (const output of ['{stem}/a.png', '{stem}/b.png', '{dir}/a.png', '{name}', '{index}.png']) /* a stem may be ".." */
            assert.match((await client.call('render', { ...small, model: '...gltf', output })).error.message, /one model/, output);
        writeFileSync(path.join(work, 'light.hdr'), 'x');
        for (const env of ['../light.hdr', `${work}/light.hdr`, 'up/light.hdr'])
            assert.equal((await client.call('render', { ...small, env })).error.code, -32002, env);
        assert.equal((await client.call('render', { ...small, root: '..' })).error.code, -32002);
        assert.equal((await client.call('bake', { environment: '../light.hdr' })).error.code, -32002);
        assert.equal((await client.call('compare', { a: '../a.png', b: 'a.png' })).error.code, -32002);
        assert.equal((await client.call('convert', { model: 'tri.gltf', output: 'a.glb', report: '../r.json' })).error.code, -32002);
        assert.equal((await client.call('inspect', { model: path.join(root, 'tri.gltf') })).result.counts.triangles, 1);
        assert(!existsSync(path.join(work, 'a.png')));
        await stop_stdio(server);
    },
    async 'lines that are no requests are answered, and end nothing'() {
        const server = await start_stdio('--max-body', '64K'), { client } = server;
        const lines = [
            ['not json', -32700], ['{"jsonrpc":"2.0","id":1,"method":"render","params":{"size":NaN}}', -32700],
            ['['.repeat(50000), -32700], [`"${'x'.repeat(300000)}"`, -32700], ['[]', -32600], ['[1]', -32600], ['{"id":4}', -32600],
            ['{"jsonrpc":"2.0","id":1,"method":"render","params":[1]}', -32602], ['\u0000\u0001', -32700], ['{"jsonrpc":"2.0","id":{},"method":"status"}', -32600],
        ];
        for (const [line, code] of lines) {
            client.write(`${line}\n`);
            const answer = await client.next();
            assert.equal((answer[0] ?? answer).error.code, code, line.slice(0, 60));
        }
        client.write('\n \r\n{"jsonrpc":"2.0","id":7,"meth');
        await sleep(20);
        client.write('od":"status"}\r\n');
        assert.equal((await client.next()).result.status, 'ok');
        await stop_stdio(server);
    },
    async 'batches, notifications and pipelined requests'() {
        const server = await start_stdio(), { client } = server;
        const call = (id, method, params) => ({ jsonrpc: '2.0', id, method, params });
        client.write(`${JSON.stringify([call('a', 'render', small), { jsonrpc: '2.0', method: 'status' }, call(null, 'status'), call(2, 'nothing'), 1])}\n`);
        const answers = await client.next();
        assert.deepEqual(answers.map((a) => a.id).sort(), ['a', 2, null, null].sort());
        assert.deepEqual(png_size(bytes_of(answers.find((a) => a.id === 'a'))), [48, 32]);
        client.write(`${JSON.stringify({ jsonrpc: '2.0', method: 'render', params: { ...small, output: 'note.png' } })}\n`);
        await wait_for('the file of a notification', () => existsSync(path.join(root, 'note.png')));
        const all = await Promise.all(Array.from({ length: 20 }, (_, i) => client.call('render', { ...small, size: 16 + i })));
        all.forEach((answer, i) => assert.deepEqual(png_size(bytes_of(answer)), [16 + i, 16 + i]));
        // in order of completion: the quick one overtakes
        const late = client.call('render', slow), early = client.call('render', small);
        assert((await Promise.race([late, early])).result);
        assert((await client.call('cancel', { id: client.last - 1 })).result.cancelled);
        assert.equal((await late).error.code, -32077);
        await stop_stdio(server);
    },
    async 'the queue is bounded'() {
        const server = await start_stdio('-j', '1', '--queue', '2'), { client } = server;
        const first = client.call('render', slow);
        await wait_for('it to run', async () => (await client.call('status')).result.running === 1);
        const waiting = [client.call('render', small), client.call('render', small)];
        const busy = (await client.call('render', small)).error;
        assert.deepEqual([busy.code, busy.data.exit_code, busy.data.reason], [-32075, 75, 'busy']);
        const cancelled = client.last - 1; // one that waits
        assert((await client.call('cancel', { id: cancelled })).result.cancelled);
        assert.equal((await waiting[1]).error.code, -32077);
        assert(!(await client.call('cancel', { id: 12345 })).result.cancelled);
        await client.call('cancel', { id: 1 });
        assert.equal((await first).error.code, -32077);
        assert((await waiting[0]).result);
        await stop_stdio(server);
    },
    async 'without a queue a free worker still answers'() {
        const server = await start_stdio('-j', '1', '--queue', '0', '-v'), { client } = server;
        assert((await client.call('render', small)).result);
        const [first, second] = await Promise.all([client.call('render', small), client.call('render', small)]);
        assert(first.result);
        assert.equal(second.error.code, -32075);
        await stop_stdio(server);
        assert.match(server.log, /render tri.gltf: done, exit code 0/);
    },
    async 'SIGTERM lets a job end and refuses what waits'() {
        const server = await start_stdio('-j', '1', '--time-limit', '3s'), { client } = server;
        const runs = client.call('render', { ...slow, size: 64 }), waits = client.call('render', small);
        await wait_for('it to run', async () => (await client.call('status')).result.running === 1);
        server.child.kill('SIGTERM');
        assert.equal((await waits).error.code, -32076);
        const refused = (await client.call('render', small)).error;
        assert.deepEqual([refused.code, refused.data.exit_code], [-32076, 75]);
        assert.deepEqual(png_size(bytes_of(await runs)), [64, 64]); // the image so far, at the time limit
        assert.equal(await server.ended, 0);
    },
    async 'a second signal ends at once'() {
        const server = await start_stdio('-j', '1'), { client } = server;
        const runs = client.call('render', slow);
        await wait_for('it to run', async () => (await client.call('status')).result.running === 1);
        server.child.kill('SIGINT');
        await wait_for('it to stop', () => server.log.includes('stopping'));
        server.child.kill('SIGINT');
        assert.equal((await runs).error.code, -32077);
        assert.equal(await server.ended, 0);
    },
    async 'a crash is an answer'() {
        const server = await start_stdio('-j', '1'), { client } = server;
        const runs = client.call('render', slow);
        await wait_for('it to run', async () => (await client.call('status')).result.running === 1);
        const children = readFileSync(`/proc/${server.child.pid}/task/${server.child.pid}/children`, 'utf8').trim().split(' ');
        process.kill(Number(children[0]), 'SIGSEGV');
        const { error } = await runs;
        assert.deepEqual([error.code, error.data.exit_code], [-32070, 128 + 11]);
        assert((await client.call('render', small)).result);
        await stop_stdio(server);
    },
    async 'the socket is private, serves several, and is removed'() {
        const { file, server, connect: open } = await start_socket('s.sock');
        assert.equal(statSync(file).mode & 0o777, 0o600);
        const clients = await Promise.all([open(), open(), open()]);
        for (const answer of await Promise.all(clients.map((c) => c.call('render', small))))
            assert.deepEqual(png_size(bytes_of(answer)), [48, 32]);
        // a client that closes its half still gets its answer
        const closing = clients[0].call('render', small);
        clients[0].socket.end();
        assert((await closing).result);
        const other = start('--socket', file);
        assert.equal(await other.ended, 6);
        assert(other.log.includes('a server is running there'), other.log);
        server.child.kill('SIGTERM');
        assert.equal(await server.ended, 0);
        assert(!existsSync(file));
    },
    async 'a dead server is replaced, another file is not'() {
        const first = await start_socket('t.sock');
        first.server.child.kill('SIGKILL');
        await first.server.ended;
        assert(existsSync(first.file));
        const second = await start_socket('t.sock');
        assert((await (await second.connect()).call('status')).result);
        second.server.child.kill('SIGTERM');
        assert.equal(await second.server.ended, 0);
        writeFileSync(first.file, 'mine');
        const third = start('--socket', first.file);
        assert.equal(await third.ended, 6);
        assert.equal(readFileSync(first.file, 'utf8'), 'mine');
    },
    async 'requests end with their client'() {
        const { server, connect: open } = await start_socket('u.sock', '-j', '1');
        const [gone, other] = [await open(), await open()];
        gone.send('render', slow, 1);
        await wait_for('it to run', async () => (await other.call('status')).result.running === 1);
        gone.socket.destroy();
        await wait_for('it to end', async () => (await other.call('status')).result.running === 0);
        server.child.kill('SIGTERM');
        assert.equal(await server.ended, 0);
    },
    async 'a program that started it and has gone takes it along'() {
        const server = await start_stdio('-j', '1');
        server.client.send('render', slow, 1);
        await wait_for('it to run', async () => (await server.client.call('status')).result.running === 1);
        server.child.stdout.destroy();
        server.child.stdin.destroy();
        assert.equal(await server.ended, 0);
    },
    async 'slow and silent clients are ended'() {
        const { file, server, connect: open } = await start_socket('v.sock', '--client-timeout', '300ms');
        const half = net.createConnection(file), idle = await open();
        half.on('error', () => {});
        half.write('{"jsonrpc":');
        await new Promise((resolve) => half.on('close', resolve).resume());
        // one that asks for more than it reads
        const deaf = net.createConnection(file);
        deaf.on('error', () => {});
        deaf.pause();
        const big = { model: 'tri.gltf', size: 1500, format: 'pfm', quality: 'draft' };
        deaf.write(`${JSON.stringify({ jsonrpc: '2.0', id: 1, method: 'render', params: big })}\n`);
        let closed = false;
        await sleep(100);
        await wait_for('the deaf client to be dropped', async () => {
            const answer = await idle.call('status'); // who waits between messages stays
            closed = answer.result.running === 0;
            return closed && (await idle.call('status')).result;
        });
        await sleep(800);
        deaf.resume();
        await new Promise((resolve) => deaf.on('close', resolve).resume());
        assert((await idle.call('render', small)).result);
        server.child.kill('SIGTERM');
        assert.equal(await server.ended, 0);
    },
    async 'command lines are checked'() {
        for (const [options, code, text] of [
            [[], 2, 'for whom?'], [['--stdio', '--mcp'], 2, 'give one of them'], [['--stdio', '--max-body', '1'], 2, '--max-body'],
            [['--http', 'x'], 2, '--http'], [['--http', '::1:8080'], 2, '--http'], [['--socket', 'no/where/a.sock'], 6, 'no/where'],
            [['--stdio', '--client-timeout', 'x'], 2, '--client-timeout'], [['--stdio', '--env', '../x.hdr'], 3, 'outside'],
        ]) {
            const server = start(...options);
            server.child.stdin.end();
            assert.equal(await server.ended, code, `${options}: ${server.log}`);
            assert(server.log.includes(text), server.log);
        }
    },
});
