// The steps of tests/web/run on the page, which reports to the server that served it.
(() => {
  window.prompt = () => null;  // the page asks where it may not write to the clipboard
  const downloads = [];
  HTMLAnchorElement.prototype.click = function () { downloads.push({name: this.download, address: this.href}); };
  const frames = [];  // ms that the explorer took for each frame
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => request((time) => {
    const start = performance.now();
    draw(time);
    frames.push(performance.now() - start);
  });
  const next = () => new Promise((resolve) => request(resolve));
  const rest = async (count) => { for (let i = 0; i < count; ++i) await next(); };
  const ask = (name, ...words) => Module.ccall('achilles_' + name, 'string', words.map(() => 'string'), words);
  const until = async (what, test) => {
    const start = performance.now();
    while (!test()) {
      if (performance.now() - start > 60000) throw new Error('never: ' + what + '; ' + note.textContent);
      await next();
    }
  };
  const mouse = (type, x, y) => Module.canvas.dispatchEvent(
    new MouseEvent(type, {clientX: x / devicePixelRatio, clientY: y / devicePixelRatio, button: 0, bubbles: true}));
  const has = (control) => ask('place', control) !== '';
  const place = (control) => {
    if (!has(control)) throw new Error('there is no ' + control);
    const [x, y, width, height] = ask('place', control).split(' ').map(Number);
    return {x, y, width, height};
  };
  const click = async (control) => {
    const {x, y, width, height} = place(control);
    for (const type of ['mousemove', 'mousedown', 'mouseup']) {
      mouse(type, x + width / 2, y + height / 2);
      await rest(3);
    }
  };
  const keyboard = (type, key, code, more) =>
    window.dispatchEvent(new KeyboardEvent(type, {key, code, bubbles: true, cancelable: true, ...more}));
  const key = async (name, code, more) => {
    for (const type of ['keydown', 'keyup']) keyboard(type, name, code, more);
    await rest(2);
  };
  const events = () => ask('events').trim().split('\n');

  // The picture without the line at the bottom, which has the time of the computation.
  const status_line = 30;
  const drawn = async () => {
    await rest(5);
    const {width, height} = Module.canvas;
    const copy = document.createElement('canvas');
    copy.width = width;
    copy.height = height - status_line;
    copy.getContext('2d').drawImage(Module.canvas, 0, 0);
    return copy.toDataURL('image/png');
  };

  async function drag(report) {
    const slider = place('set e');
    const at = (share) => [slider.x + share * slider.width, slider.y + slider.height / 2];
    mouse('mousemove', ...at(0.5));
    await rest(3);
    mouse('mousedown', ...at(0.5));
    await rest(3);
    mouse('mousemove', ...at(0.47));  // far enough to be a drag
    await rest(3);
    const before = ask('events'), first = frames.length;
    report.run_ms = [];  // of the computation alone
    report.drag_frames = 0;  // until the events are those of the new value, at most
    for (const share of [0.43, 0.39, 0.35, 0.31]) {
      const now = ask('events');
      mouse('mousemove', ...at(share));
      let count = 0;
      while (ask('events') === now && count < 10) { await next(); ++count; }
      report.run_ms.push(1e3 * Number(ask('seconds')));
      report.drag_frames = Math.max(report.drag_frames, count);
    }
    report.drag_frame_ms = frames.slice(first).sort((a, b) => a - b);
    mouse('mouseup', ...at(0.31));
    await rest(5);
    if (ask('events') === before) throw new Error('the slider moved nothing');
  }

  // A run of seconds: frames and input go on meanwhile. The first is stopped by the value before it, the second ends.
  async function waitForLongRun(report) {
    const slider = place('set e');
    const at = (share) => [slider.x + share * slider.width, slider.y + slider.height / 2];
    const short = ask('events');
    mouse('mousemove', ...at(0.3));
    await rest(3);
    mouse('mousedown', ...at(0.3));
    await rest(3);
    mouse('mousemove', ...at(0.4));
    await until('the run before', () => ask('events') !== short);
    await rest(3);
    const before = ask('events'), first = frames.length;
    mouse('mousemove', ...at(1.2));
    await rest(10);
    report.goes_on = ask('events') === before;
    mouse('mousemove', ...at(0.5));
    await until('the run after a stopped one', () => ask('events') !== before);
    report.stopped_run_ms = 1e3 * Number(ask('seconds'));
    const between = ask('events'), start = performance.now();
    mouse('mousemove', ...at(1.2));
    await until('the long run', () => ask('events') !== between);
    report.long_run_ms = performance.now() - start;
    report.long_run_frame_ms = frames.slice(first).sort((a, b) => a - b);
    mouse('mouseup', ...at(1.2));
    await rest(5);
  }

  // Types a command into the palette.
  async function order(words) {
    const held = {ctrlKey: true, shiftKey: true};
    keyboard('keydown', 'Control', 'ControlLeft');
    keyboard('keydown', 'Shift', 'ShiftLeft');
    await rest(2);
    await key('P', 'KeyP', held);
    keyboard('keyup', 'Shift', 'ShiftLeft');
    keyboard('keyup', 'Control', 'ControlLeft');
    await rest(5);
    for (const letter of words) await key(letter, letter === ' ' ? 'Space' : 'Key' + letter.toUpperCase());
    await key('Enter', 'Enter');
  }

  const textOf = (blob) => new Promise((resolve) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result);
    reader.readAsDataURL(blob);
  });

  async function copyLink() {
    await order('copy link');
    await until('a copied link', () => ask('copied') !== '');
    await rest(10);
  }

  // Instead of the clipboard, which a browser without a user does not give.
  async function copyPicture(report) {
    let copied = null;
    navigator.clipboard.write = async (items) => { copied = await items[0].getType('image/png'); };
    await order('copy picture');
    await until('a copied picture', () => copied !== null);
    report.copied_picture = await textOf(copied);
  }

  async function exportPicture(report) {
    await order('export figure.png');
    await until('a download', () => downloads.length > 0);
    report.exported_picture = await textOf(await (await fetch(downloads[0].address)).blob());
  }

  // The browser's dialog for files, which a user answers at once.
  async function open(report) {
    const text = await (await fetch('/dropped.toml')).text();
    HTMLInputElement.prototype.click = function () {
      const chosen = new DataTransfer();
      chosen.items.add(new File([text], 'chosen.toml'));
      this.files = chosen.files;
      this.dispatchEvent(new Event('change'));
    };
    await click('bar File');
    await click('menu Open\u2026');
    await until('the chosen system', () => ask('session').includes('system chosen.toml'));
    report.chosen = ask('session');
  }

  async function exportFigure(report) {
    await click('bar File');
    await click('menu Export figure\u2026');
    await rest(5);
    report.export_picture = await drawn();
    report.offers_film = has('take a film: the mechanism in motion beside the plots');
    await click('dialog Export');
    await until('a download', () => downloads.length > 0);
    report.download = downloads[0].name;
    report.download_text = await (await fetch(downloads[0].address)).text();
  }

  // A file of the user, dropped on the page.
  async function drop(report) {
    const text = await (await fetch('/dropped.toml')).text();
    const dropped = new DataTransfer();
    dropped.items.add(new File([text], 'dropped.toml'));
    window.dispatchEvent(new DragEvent('drop', {dataTransfer: dropped, cancelable: true}));
    await until('the dropped system', () => ask('session').includes('system dropped.toml'));
    report.dropped = ask('session');
  }

  // A click on the plot: the pointer and the keyboard reach the page.
  async function play(report) {
    await key(' ', 'Space');
    const start = ask('session').match(/time (\S+)/)[1];
    await rest(20);
    report.plays = ask('session').match(/time (\S+)/)[1] !== start;
    await key(' ', 'Space');
  }

  async function run() {
    const report = {};
    const asked = new URLSearchParams(location.search), steps = (asked.get('steps') || '').split(',');
    if (asked.has('size')) [Module.canvas.style.width, Module.canvas.style.height] = asked.get('size').split('x').map((n) => n + 'px');
    await until('the explorer runs', () => Module.calledRun && note.style.display === 'none' && ask('session') !== '');
    await until('its first frame', () => has('play'));
    report.first_paint_ms = performance.now();
    await rest(5);
    if (steps.includes('tour')) await until('the first sentence of the tour', () => ask('session').includes('says '));
    if (location.hash !== '') await rest(60);  // studies of the session end
    report.size = Module.canvas.width + 'x' + Module.canvas.height;
    report.events = events();
    report.picture = await drawn();
    if (steps.includes('drag')) await drag(report);
    if (steps.includes('long')) await waitForLongRun(report);
    if (steps.includes('link')) await copyLink();
    if (steps.includes('play')) await play(report);
    if (steps.includes('export')) await exportFigure(report);
    if (steps.includes('drop')) await drop(report);
    if (steps.includes('open')) await open(report);
    if (steps.includes('picture')) await exportPicture(report);
    if (steps.includes('picture')) await copyPicture(report);
    report.link = ask('copied');
    report.session = ask('session');
    report.asks = has('dialog Refuse');
    report.moved_events = events();
    report.last_picture = await drawn();
    return report;
  }

  window.addEventListener('load', () => run()
    .catch((problem) => ({failure: (problem.message || problem) + ' / ' + note.textContent}))
    .then((report) => fetch('/report', {method: 'POST', body: JSON.stringify(report)})));
})();
