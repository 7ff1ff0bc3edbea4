// words.mjs: the spellings of each class of tokens, from the table of the lexer, as JSON.
//
//     node words.mjs compiler/front/token.def
import fs from 'node:fs';

const classes = {};
for (const [, spelling, name] of fs.readFileSync(process.argv[2], 'utf8').matchAll(/^TOKEN\([A-Z_]+, *"([^"]+)", *([A-Z_]+)\)/gm))
    (classes[name] ??= []).push(spelling);
process.stdout.write(JSON.stringify(classes));
