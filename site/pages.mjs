// pages.mjs: the pages of the site, in the order of its contents.
//
// A row is the page's place, its title, and what it is made of: a document of the repository, or a part of
// reference.mjs.  What a document links to besides becomes a page below source/.

export const chapters = [
    { title: 'Begin', pages: [
        { place: 'docs/tutorial.html', title: 'Tutorial', document: 'docs/tutorial.md' },
        { place: 'docs/coming-from.html', title: 'If you know another program', document: 'docs/coming-from.md' },
        { place: 'gallery.html', title: 'Gallery', part: 'gallery' },
        { place: 'docs/features.html', title: 'What it does, and what not', document: 'docs/features.md' },
    ] },
    { title: 'Language', pages: [
        { place: 'docs/language.html', title: 'The language', document: 'docs/language.md' },
        { place: 'reference/shapes.html', title: 'Shapes', part: 'shapes' },
        { place: 'reference/functions.html', title: 'Functions and methods', part: 'functions' },
        { place: 'reference/nature.html', title: 'Trees, plants, surfaces, patterns', part: 'files' },
        { place: 'reference/colours.html', title: 'Colours', part: 'colours' },
        { place: 'reference/diagnostics.html', title: 'Diagnostics', part: 'diagnostics' },
    ] },
    { title: 'Use', pages: [
        { place: 'reference/commands.html', title: 'Commands', part: 'commands' },
        { place: 'docs/viewer.html', title: 'The viewer', document: 'docs/viewer.md' },
        { place: 'docs/playground.html', title: 'The playground', document: 'docs/playground.md' },
        { place: 'docs/editors.html', title: 'Editors', document: 'docs/editors.md' },
        { place: 'docs/meshes.html', title: 'Meshes', document: 'docs/meshes.md' },
        { place: 'docs/slices.html', title: 'Sections', document: 'docs/slices.md' },
        { place: 'docs/grids.html', title: 'Grids', document: 'docs/grids.md' },
        { place: 'docs/exports.html', title: 'Other programs', document: 'docs/exports.md' },
        { place: 'docs/printing.html', title: 'Figures of a part', document: 'docs/printing.md' },
        { place: 'docs/denoising.html', title: 'Less noise', document: 'docs/denoising.md' },
        { place: 'docs/cost.html', title: 'What parts cost', document: 'docs/cost.md' },
        { place: 'docs/farm.html', title: 'Many machines', document: 'docs/farm.md' },
    ] },
    { title: 'Libraries', pages: [
        { place: 'docs/library.html', title: 'krs from C', document: 'docs/library.md' },
        { place: 'reference/c.html', title: 'C reference', part: 'c' },
        { place: 'docs/python.html', title: 'krs from Python', document: 'docs/python.md' },
        { place: 'reference/python.html', title: 'Python reference', part: 'python' },
        { place: 'docs/javascript.html', title: 'krs in pages', document: 'web/package/README.md' },
        { place: 'reference/javascript.html', title: 'JavaScript reference', part: 'javascript' },
    ] },
    { title: 'How it works', pages: [
        { place: 'docs/how-it-works.html', title: 'How krs works', document: 'docs/how-it-works.md' },
        { place: 'docs/math.html', title: 'The mathematics', document: 'docs/math.md' },
        { place: 'docs/figures.html', title: 'How fast it is', document: 'docs/figures.md' },
        { place: 'docs/reliability.html', title: 'Reliability', document: 'docs/reliability.md' },
        { place: 'docs/architecture.html', title: 'Architecture', document: 'docs/architecture.md' },
        { place: 'docs/code.html', title: 'The code', document: 'docs/code.md' },
        { place: 'docs/glossary.html', title: 'Glossary', document: 'docs/glossary.md' },
    ] },
    { title: 'Project', pages: [
        { place: 'docs/building.html', title: 'Building, testing, measuring', document: 'docs/building.md' },
        { place: 'docs/packaging.html', title: 'Packages', document: 'docs/packaging.md' },
        { place: 'docs/contributing.html', title: 'Contributing', document: 'CONTRIBUTING.md' },
        { place: 'docs/changelog.html', title: 'Changelog', document: 'CHANGELOG.md' },
        { place: 'docs/security.html', title: 'Security', document: 'SECURITY.md' },
    ] },
];
