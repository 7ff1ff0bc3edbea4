// index.mjs: what the package `krs` has (krs.d.ts).
export { Scene, check, compile, format, locate, version } from './compiler.mjs';
