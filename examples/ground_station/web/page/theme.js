// The theme: the one that was chosen last, else what the system prefers. A plain script, for it must run before the
// first paint.
(() => {
  const names = ['auto', 'light', 'dark', 'contrast', 'night'];
  const key = 'rabit.theme';
  const prefers = (query) => window.matchMedia(query).matches;
  const read = () => {
    try {
      const stored = localStorage.getItem(key);
      return names.includes(stored) ? stored : 'auto';
    } catch {
      return 'auto';  // storage is switched off: the choice lasts as long as the page
    }
  };
  let chosen = read();
  const apply = () => {
    let theme = chosen;
    if (theme === 'auto') {
      if (prefers('(prefers-contrast: more)')) theme = 'contrast';
      else theme = prefers('(prefers-color-scheme: dark)') ? 'dark' : 'light';
    }
    document.documentElement.dataset.theme = theme;
    document.documentElement.dispatchEvent(new CustomEvent('themechange'));
  };
  for (const query of ['(prefers-contrast: more)', '(prefers-color-scheme: dark)'])
    window.matchMedia(query).addEventListener('change', apply);
  window.rabitTheme = {
    chosen: () => chosen,
    next() {
      chosen = names[(names.indexOf(chosen) + 1) % names.length];
      try {
        localStorage.setItem(key, chosen);
      } catch {
        // as above
      }
      apply();
    },
  };
  apply();
})();
