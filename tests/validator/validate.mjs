// validate.mjs - prints what Khronos' validator finds wrong with glTF files; exit code 1 where there is an error.
//     node validate.mjs FILE...
import { readFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import validator from 'gltf-validator';

let failed = false;
for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
        uri: file,
        maxIssues: 100,
        externalResourceFunction: async (uri) =>
            new Uint8Array(await readFile(join(dirname(file), decodeURIComponent(uri)))),
    });
    for (const issue of report.issues.messages) {
        if (issue.severity > 0)
            continue;
        console.log(`${file}: ${issue.pointer ?? ''}: ${issue.code}: ${issue.message}`);
        failed = true;
    }
}
process.exitCode = failed ? 1 : 0;
