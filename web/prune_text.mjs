// prune_text.mjs IN OUT UNUSED SOURCE... - the tables of shader text (IN/gl_text.h, IN/glsl_text.h) for one module, in OUT: without the
// parts whose names match the regular expression UNUSED, and without the functions that no text calls then. SOURCE: files of C
// that may write calls of their own; the functions that they name are kept.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';

const [from, to, unused, ...sources] = process.argv.slice(2);
const ARRAY = /static const unsigned char (\w+)\[\] = \{([\d,\n]*?)0\};\n/g;
const ENTRY = new RegExp(`\\n *\\{"(?:${unused})", [^\\n]*`, 'g');

const tables = ['gl_text.h', 'glsl_text.h'].map((name) => {
    const whole = readFileSync(path.join(from, name), 'utf8').replace(ENTRY, '');
    const list = whole.replace(ARRAY, '');
    const texts = new Map();
    for (const [, array, bytes] of whole.matchAll(ARRAY)) {
        // what the list lacks is unused, but for what glsl.c names itself (text_0, khronos_begin, ...)
        if (/^text_[1-9]/.test(array) && !new RegExp(`\\b${array}\\b`).test(list)) continue;
        texts.set(array, Buffer.from(bytes.split(',').filter((byte) => byte.trim()).map(Number)).toString());
    }
    return { name, list, texts };
});

// The end of what is bracketed from `begin` on.
function closing(text, begin, open, close) {
    let depth = 0;
    for (let i = begin; i < text.length; i++) {
        if (text[i] === open) depth++;
        else if (text[i] === close && --depth === 0) return i + 1;
    }
    throw new Error(`${open} is not closed`);
}

// The functions that text defines: name, begin, end.
function* definitions(text) {
    for (const { 0: head, 1: name, index } of text.matchAll(/^(?:\w+ )?\w+ (\w+)\(/gm)) {
        const parameters = closing(text, index + head.length - 1, '(', ')');
        const body = /^\s*\{/.exec(text.slice(parameters));
        if (!body) continue;
        const end = closing(text, parameters, '{', '}');
        yield { name, begin: index, end: text[end] === '\n' ? end + 1 : end };
    }
}

// How often each name stands in the texts.
function count(texts) {
    const counts = new Map();
    for (const text of texts) {
        for (const [name] of text.matchAll(/[A-Za-z_]\w*/g)) counts.set(name, (counts.get(name) ?? 0) + 1);
    }
    return counts;
}

const named = count(sources.map((source) => readFileSync(source, 'utf8')));
named.set('main', 1);
for (let removed = true; removed;) { // what only a removed function called goes in the next round
    removed = false;
    const defined = new Map(); // a name may have several definitions: by types of arguments, by conditions
    for (const { texts } of tables) {
        for (const text of texts.values()) {
            for (const { name } of definitions(text)) defined.set(name, (defined.get(name) ?? 0) + 1);
        }
    }
    const counts = count(tables.flatMap(({ texts }) => [...texts.values()]));
    for (const { texts } of tables) {
        for (const [array, text] of texts) {
            let kept = '';
            let end = 0;
            for (const one of definitions(text)) {
                if (named.has(one.name) || counts.get(one.name) > defined.get(one.name)) continue;
                kept += text.slice(end, one.begin);
                ({ end } = one);
                removed = true;
            }
            texts.set(array, kept + text.slice(end));
        }
    }
}

mkdirSync(to, { recursive: true });
for (const { name, list, texts } of tables) {
    const arrays = [...texts].map(([array, text]) => `static const unsigned char ${array}[] = {${[...Buffer.from(text)].map((byte) => `${byte},`).join('')}0};\n`);
    writeFileSync(path.join(to, name), arrays.join('') + list);
}
