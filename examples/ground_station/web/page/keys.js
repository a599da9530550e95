// One key for each action. They work wherever no text is being typed.
import {byId, element} from './dom.js';

export function listenForKeys(actions) {
  const list = byId('keys-list');
  for (const {key, what} of actions) {
    const term = element('dt');
    term.append(element('kbd', '', key === 'Escape' ? 'Esc' : key));
    list.append(term, element('dd', '', what));
  }
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.isComposing || event.defaultPrevented) return;
    const typing = event.target instanceof HTMLInputElement;
    if (typing && event.key !== 'Escape') return;
    if (byId('keys').open) return;
    const action = actions.find(({key}) => key === event.key);
    if (!action) return;
    event.preventDefault();
    action.run();
  });
}
