// http.mjs - facet serve --http.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import path from 'node:path';
import { png_size, root, run, sleep, slow, start, triangle, wait_for, work } from './lib.mjs';

async function start_http(...options) {
    const server = start('--http', '0', ...options);
    server.url = await wait_for('the address', () => server.log.match(/serving at (http:\S+)/)?.[1]);
    server.port = Number(new URL(server.url).port);
    server.get = (what, init) => fetch(server.url + what, init);
    server.post = (what, body, headers = {}) => server.get(what, { method: 'POST', body, headers });
    server.health = async () => (await server.get('health')).json();
    return server;
}

async function stop(server, code = 0) {
    server.child.kill('SIGTERM');
    assert.equal(await server.ended, code, server.log);
}

const bytes_of = async (response) => Buffer.from(await response.arrayBuffer());
const query = (params) => `render?${new URLSearchParams(params)}`;

// Sends bytes as they are; resolves with what came until the connection closed.
function raw(port, bytes) {
    return new Promise((resolve) => {
        let all = '';
        const socket = net.createConnection(port, '127.0.0.1', () => socket.write(bytes));
        socket.on('data', (text) => { all += text; });
        socket.on('close', () => resolve(all));
        socket.on('error', () => {});
    });
}

await run({
    async 'GET and POST give an image with its type'() {
        const server = await start_http();
        const got = await server.get('render?model=tri.gltf&size=48x32&specular-aa');
        assert.equal(got.status, 200);
        assert.equal(got.headers.get('content-type'), 'image/png');
        assert.deepEqual(png_size(await bytes_of(got)), [48, 32]);
        const posted = await server.post('render?size=48x32&format=webp', triangle(), { 'content-type': 'model/gltf+json' });
        assert.equal(posted.headers.get('content-type'), 'image/webp');
        assert.equal((await bytes_of(posted)).subarray(8, 12).toString(), 'WEBP');
        const named = await server.post('inspect?name=chair.gltf', triangle());
        assert.deepEqual([named.status, (await named.json()).counts.triangles], [200, 1]);
        const converted = await server.get('convert?model=tri.gltf');
        assert.equal(converted.headers.get('content-type'), 'model/gltf-binary');
        assert.equal((await bytes_of(converted)).subarray(0, 4).toString(), 'glTF');
        writeFileSync(path.join(root, 'a.png'), await bytes_of(await server.get('render?model=tri.gltf&size=16')));
        const compared = await (await server.get('compare?a=a.png&b=a.png')).json();
        assert.equal(compared.metrics.max, 0);
        const baked = await server.get('bake?environment=sun:40,135&size=16&mips=1');
        assert.equal(baked.headers.get('content-type'), 'image/ktx2');
        assert.match(await (await server.get('')).text(), /GET {2}\/render/);
        await stop(server);
    },
    async 'the same image is not sent twice'() {
        const server = await start_http();
        const first = await server.get('render?model=tri.gltf&size=16'), etag = first.headers.get('etag');
        assert.equal(first.headers.get('cache-control'), 'no-cache');
        const headers = { 'if-none-match': etag };
        assert.equal((await server.get('render?model=tri.gltf&size=16', { headers })).status, 304);
        assert.equal((await server.get('render?model=tri.gltf&size=17', { headers })).status, 200);
        await stop(server);
    },
    async 'errors are JSON with a fitting status'() {
        const server = await start_http('--max-body', '64K');
        for (const [what, status, exit_code, text] of [
            ['render', 400, 2, 'model is missing'], ['render?model=tri.gltf&size=x', 400, 2, '--size'],
            ['render?model=tri.gltf&sise=1', 400, 2, 'did you mean'], ['render?model=tri.gltf&denoise=maybe', 400, 2, 'true or false'],
            ['render?model=tri.gltf&model=b', 400, 2, 'twice'], ['render?model=tri.gltf&output=a.png', 400, 2, 'response'],
            ['render?model=tri.gltf&turntable=2&size=16', 400, 2, '2 files'], ['render?model=tri.gltf&size=%ff', 400, 2, 'UTF-8'],
            ['render?model=missing.glb', 404, 3, 'missing.glb'], ['render?model=broken.glb', 422, 4, 'broken.glb'],
            ['render?model=future.gltf', 415, 5, 'EXT_unknown'], ['render?model=../secret.gltf', 403, 3, 'outside'],
            ['render?model=..%2fsecret.gltf', 403, 3, 'outside'], ['render?model=link.gltf', 403, 3, 'outside'],
            ['render?model=/etc/passwd', 403, 3, 'outside'], ['render?model=tri.gltf&env=up/x.hdr', 403, 3, 'outside'],
            [query({ ...slow, 'time-limit': '100ms', size: 4096, format: 'pfm' }), 504, 7, 'time'],
            ['render?model=tri.gltf&size=8192&max-memory=16M', 413, 7, 'memory'], ['nothing', 404, 2, 'no page'], ['render/x', 404, 2, 'no page'],
        ]) {
            const response = await server.get(what);
            assert.equal(response.headers.get('content-type'), 'application/json', what);
            const { error } = await response.json();
            assert.deepEqual([response.status, error.status, error.exit_code], [status, status, exit_code], `${what}: ${error.message}`);
            assert(error.message.includes(text), `${what}: ${error.message}`);
        }
        for (const [status, what, body, headers] of [
            [400, 'render', ''], [413, 'render', 'x'.repeat(100000)], [422, 'render', 'no model'], [405, 'compare?b=a.png', 'x'],
            [415, 'render', 'x', { 'content-type': 'multipart/form-data; boundary=x' }], [400, 'render?model=tri.gltf', 'x'],
            [400, 'render?name=../x', 'x'],
        ])
            assert.equal((await server.post(what, body, headers)).status, status, `${what} ${body.slice(0, 10)}`);
        const deleted = await server.get('render?model=tri.gltf', { method: 'DELETE' });
        assert.deepEqual([deleted.status, deleted.headers.get('allow')], [405, 'GET, POST']);
        // a body without a stated length
        const parts = (async function* () { for (let i = 0; i < 40; i++) yield Buffer.alloc(4096); })();
        const chunked = await server.get('render', { method: 'POST', body: parts, duplex: 'half' }).catch(() => ({ status: 413 }));
        assert.equal(chunked.status, 413);
        await stop(server);
    },
    async 'only this machine is meant'() {
        const server = await start_http();
        assert(server.url.startsWith('http://127.0.0.1:'));
        const head = (host, more = '') => `GET /health HTTP/1.1\r\nHost: ${host}\r\n${more}Connection: close\r\n\r\n`;
        for (const host of ['evil.example', 'localhost.evil.example', '[::1].evil.example', '[::1', ''])
            assert.match(await raw(server.port, head(host)), /^HTTP\/1.1 403/, host);
        for (const host of [`localhost:${server.port}`, '127.0.0.1', '[::1]:80'])
            assert.match(await raw(server.port, head(host)), /^HTTP\/1.1 200/, host);
        const far = 'Sec-Fetch-Site: cross-site\r\n'; /* what browsers say about pages */
        for (const more of ['Origin: https://evil.example\r\n', 'Origin: null\r\n', far, `${far}Referer: https://evil.example/localhost\r\n`])
            assert.match(await raw(server.port, head('localhost', more)), /^HTTP\/1.1 403/, more);
        for (const more of ['Origin: http://localhost:3000\r\n', 'Sec-Fetch-Site: same-site\r\n', `${far}Referer: http://127.0.0.1:3000/a/\r\n`])
            assert.match(await raw(server.port, head('localhost', more)), /^HTTP\/1.1 200/, more);
        await stop(server);
    },
    async 'it listens again after too many connections'() {
        const server = await start_http();
        const idle = Array.from({ length: 200 }, () => net.createConnection(server.port, '127.0.0.1').on('error', () => {}));
        await wait_for('connections', () => idle.every((socket) => !socket.connecting));
        await sleep(300);
        server.child.kill('SIGSTOP'); /* it shall see all ends at once */
        for (const socket of idle) socket.destroy();
        await sleep(100);
        server.child.kill('SIGCONT');
        await sleep(300);
        assert.match(await raw(server.port, 'GET /health HTTP/1.0\r\n\r\n'), /^HTTP\/1.. 200/);
        await stop(server);
    },
    async 'what is no HTTP ends its connection only'() {
        const server = await start_http('--client-timeout', '500ms');
        for (const bytes of ['\0\x01\x02\r\n\r\n', 'GET / HTTP/9.9\r\n\r\n', `GET /${'x'.repeat(100000)} HTTP/1.1\r\nHost: localhost\r\n\r\n`,
            'POST /render HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999999999999\r\n\r\n', 'GET /render?model=tri.gltf HTTP/1.1\r\nHost: x'])
            await raw(server.port, bytes);
        // a head that never ends, and a body that stays away
        const begun = Date.now();
        const drip = net.createConnection(server.port, '127.0.0.1');
        drip.on('error', () => {});
        const timer = setInterval(() => drip.write('X-A: b\r\n'), 100);
        drip.write('GET /health HTTP/1.1\r\nHost: localhost\r\n');
        await new Promise((resolve) => drip.on('close', resolve).resume());
        clearInterval(timer);
        await raw(server.port, 'POST /render HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\nxx');
        assert(Date.now() - begun < 10000);
        assert.equal((await server.get('render?model=tri.gltf&size=16')).status, 200);
        await stop(server);
    },
    async 'a full queue says when to come back'() {
        const server = await start_http('-j', '1', '--queue', '1');
        const abort = new AbortController(), first = server.get(query(slow), { signal: abort.signal }).catch(() => 'gone');
        await wait_for('it to run', async () => (await server.health()).running === 1);
        const second = server.get('render?model=tri.gltf&size=16');
        await wait_for('one to wait', async () => (await server.health()).waiting === 1);
        const busy = await server.get('render?model=tri.gltf&size=16');
        assert.deepEqual([busy.status, busy.headers.get('retry-after')], [429, '1']);
        // the client of the first goes: its job ends, the second has its turn
        abort.abort();
        assert.equal(await first, 'gone');
        assert.equal((await second).status, 200);
        const metrics = await (await server.get('metrics')).text();
        for (const line of ['facet_requests_total{transport="http",method="render",code="429",reason="busy"} 1', 'facet_abandoned_total 1',
            'facet_requests_total{transport="http",method="render",code="200",reason="done"} 1', 'facet_jobs_total{end="cancelled"} 1',
            'facet_request_seconds_count{method="render"} 1', 'facet_queue_depth 0', 'facet_jobs_running 0'])
            assert(metrics.includes(`\n${line}\n`), `${line} is missing in\n${metrics}`);
        for (const line of metrics.trim().split('\n'))
            assert.match(line, /^(# (HELP|TYPE) [a-z_]+ .+|[a-z_]+(\{([a-z]+="[^"]*",?)+\})? [0-9.e+-]+)$/);
        await stop(server);
    },
    async 'many at once, over connections that stay'() {
        const server = await start_http('--queue', '100'), agent = new http.Agent({ keepAlive: true, maxSockets: 8 });
        const get = (size) => new Promise((resolve, reject) => {
            http.get(`${server.url}render?model=tri.gltf&size=${size}`, { agent }, (response) => {
                const parts = [];
                response.on('data', (part) => parts.push(part)).on('end', () => resolve(Buffer.concat(parts)));
            }).on('error', reject);
        });
        const images = await Promise.all(Array.from({ length: 40 }, (_, i) => get(16 + i)));
        images.forEach((image, i) => assert.deepEqual(png_size(image), [16 + i, 16 + i]));
        agent.destroy();
        await stop(server);
    },
    async 'SIGTERM lets a job end'() {
        const server = await start_http('-j', '1', '--time-limit', '2s');
        const runs = server.get(query({ ...slow, size: 64 }));
        await wait_for('it to run', async () => (await server.health()).running === 1);
        const waits = server.get('render?model=tri.gltf&size=16');
        await wait_for('one to wait', async () => (await server.health()).waiting === 1);
        server.child.kill('SIGTERM');
        assert.equal((await waits).status, 503);
        assert.deepEqual(png_size(await bytes_of(await runs)), [64, 64]);
        assert.equal(await server.ended, 0);
        await assert.rejects(server.health());
    },
    async 'other ways in at the same time'() {
        const server = await start_http('--socket', path.join(work, 'w.sock'), '--stdio');
        server.child.stdin.end(); // the others go on
        await sleep(100);
        assert.equal((await server.health()).status, 'ok');
        await stop(server);
        assert(readFileSync(path.join(root, 'tri.gltf')));
    },
});
