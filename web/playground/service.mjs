// service.mjs: keeps the playground for times without a network.  The build puts the list of files and their hash before it.
/* global FILES, VERSION */
const PREFIX = 'krs-playground-', NAME = PREFIX + VERSION;

addEventListener('install', event => event.waitUntil(
    caches.open(NAME).then(cache => cache.addAll(FILES.map(file => new Request(file, { cache: 'reload' }))))));

addEventListener('activate', event => event.waitUntil(
    caches.keys().then(names => Promise.all(names.filter(name => name.startsWith(PREFIX) && name !== NAME).map(name => caches.delete(name))))));

addEventListener('fetch', event => {
    if (event.request.method === 'GET' && new URL(event.request.url).origin === location.origin)
        event.respondWith(caches.open(NAME).then(cache => cache.match(event.request, { ignoreSearch: true }))
            .then(found => found ?? fetch(event.request)));
});
