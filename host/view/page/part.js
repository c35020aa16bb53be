// One drawing part of the page. It fails alone, shows its error in its own place, and is restarted after a while.
const FIRST_WAIT_MS = 1000, LONGEST_WAIT_MS = 32_000, SOUND_AFTER_MS = 10_000;

export class Part {
  /**
   * @param what {name, place(), make(attempt, signal), dispose?(value), text?(value, text),
   * draw?(value, time_ms)}:
   * `place` returns the element that shows a failure; `make` returns the part's object, or a promise of it; `attempt`
   * is 0 at first and is used to change the module's address, because a browser does not load a failed module again.
   * `signal` is aborted when the part fails, also in the middle of `make`: listeners that are added with it end, so
   * that after a restart a click does not act twice.
   */
  constructor(what) {
    Object.assign(this, { what, value: null, attempt: 0, wait_ms: FIRST_WAIT_MS, failures: 0 });
  }

  /** @param told everything the host has sent so far, for a part that is made later. */
  async start(told) {
    this.told = told;
    this.ending = new AbortController();
    try {
      const value = await this.what.make(this.attempt++, this.ending.signal);
      this.value = value;
      this.made_ms = performance.now();
      this.#say('');
      this.what.text?.(value, told);
    } catch (error) { this.#fail(error); }
  }

  /** @returns the result of `use`, or undefined when the part does not exist or throws. */
  run(use) {
    if (this.value === null) return undefined;
    try { return use(this.value); } catch (error) { this.#fail(error); return undefined; }
  }

  text(text) { if (this.what.text) this.run((value) => this.what.text(value, text)); }
  draw(time_ms) { if (this.what.draw) this.run((value) => this.what.draw(value, time_ms)); }

  /** Reports a failure that did not occur inside one of the part's calls. */
  fail(error) { if (this.value !== null) this.#fail(error); }

  #fail(error) {
    const value = this.value;
    this.value = null;
    ++this.failures;
    try { this.what.dispose?.(value); } catch { /* it has failed already */ }
    this.ending.abort();
    if (value !== null && performance.now() - this.made_ms > SOUND_AFTER_MS) this.wait_ms = FIRST_WAIT_MS;
    this.#say(`${this.what.name}: ${error?.message ?? error}. Next try in ${this.wait_ms / 1000} s.`);
    setTimeout(() => this.start(this.told), this.wait_ms);
    this.wait_ms = Math.min(2 * this.wait_ms, LONGEST_WAIT_MS);
  }

  #say(text) {
    this.note ??= Object.assign(document.createElement('p'), { className: 'part-note' });
    this.note.hidden = !text;
    this.note.textContent = text;
    this.note.dataset.part = this.what.name;
    const place = this.what.place();
    if (text && this.note.parentElement !== place) place.append(this.note);
  }
}
