// What is copied from the page has exact numbers, although three digits are shown. An element that shows rounded numbers
// has the exact text in its attribute data-exact.

/** @param cursorText exact text of the tick under the mouse, or ''; it is copied when nothing is selected. */
export function setUpCopying(cursorText) {
  const copy = (event) => {
    if (event.target.closest?.('input, textarea')) return;
    const text = exactSelection(document.getSelection()) ?? cursorText();
    if (!text) return;
    event.clipboardData.setData('text/plain', text);
    event.preventDefault();
  };
  document.addEventListener('copy', copy);
  return () => document.removeEventListener('copy', copy);
}

/** The selected text with exact numbers; null when nothing is selected. */
function exactSelection(selection) {
  if (!selection || selection.isCollapsed) return null;
  const range = selection.getRangeAt(0), inside = range.commonAncestorContainer;
  const around = (inside.nodeType === Node.ELEMENT_NODE ? inside : inside.parentElement).closest('[data-exact]');
  if (around) return around.dataset.exact;
  const piece = range.cloneContents();
  for (const element of piece.querySelectorAll('[data-exact]')) element.textContent = element.dataset.exact;
  return piece.textContent;
}
