// page.js: what page.h asks of the page, as core.mjs answers it.
mergeInto(LibraryManager.library, {
    page_load: function (path, length) { return Module['load'](path, length); },
    page_font: function (name, length, face) { return Module['font'](name, length, face); },
    page_letters: function (font, length, face, text, lettering, count) {
        return Module['letters'](font, length, face, text, lettering, count);
    },
    page_progress: function (done) { return Module['progress'](done); },
});
