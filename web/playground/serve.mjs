// serve.mjs: shows the folder of the playground at localhost.
//
//     node serve.mjs FOLDER PORT
import { serve } from '../../tests/web/browser.mjs';

const [folder, port] = process.argv.slice(2);
const { url } = await serve(folder, Number(port));
console.log(`The playground is at ${url} until Ctrl C.`);
