// theme.js: light or dark, before anything is drawn.
try {
    const chosen = localStorage.getItem('krs-theme');
    if (chosen === 'light' || chosen === 'dark')
        document.documentElement.dataset.theme = chosen;
} catch {
    // What may not be kept is as the system says.
}
