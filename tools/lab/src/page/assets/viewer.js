// The images of one scene: flip, slider or side by side, with zoom and pan in step.

const MODES = ["flip", "slider", "grid"];
const LAYERS = ["image", "difference", "flip-map"];

class Viewer {
  /** `root` is the element of the page, `scene` what the page's data say of it. */
  constructor(root, scene, maps) {
    this.root = root;
    this.maps = maps;
    this.size = scene.size;
    this.pictures = scene.pictures;
    this.state = {mode: "flip", layer: "image", shown: Math.min(1, this.pictures.length - 1), left: 0, right: this.pictures.length - 1,
      split: 0.5, curve: "agx", stops: 0, gain: 0, means: false};
    this.view = {zoom: 1, x: this.size[0] / 2, y: this.size[1] / 2};
    this.canvases = new Map();
    this.stage = root.querySelector(".stage");
    this.canvas = root.querySelector("canvas");
    this.divider = root.querySelector(".divider");
    this.bind();
    this.reflect();
    new ResizeObserver(() => this.draw()).observe(this.stage);
    // Decoding waits until somebody looks.
    const seen = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      this.ready = true;
      this.set({stops: automaticExposure(this.radianceOf(0))});
    }, {rootMargin: "200px"});
    seen.observe(this.stage);
  }

  find(name) {
    return this.root.querySelector(`[data-is="${name}"]`);
  }

  set(change) {
    Object.assign(this.state, change);
    this.reflect();
    this.draw();
  }

  /** The controls and attributes show the state. */
  reflect() {
    const {mode, layer, shown, left, right, split, curve, means} = this.state;
    Object.assign(this.stage.dataset, {mode, layer, shown});
    for (const button of this.root.querySelectorAll("button[data-set]")) {
      const [key, value] = button.dataset.set.split("=");
      button.setAttribute("aria-pressed", String(this.state[key]) === value);
    }
    this.find("curve").value = curve;
    this.find("left").value = left;
    this.find("right").value = right;
    this.find("sides").hidden = mode !== "slider";
    this.find("names").hidden = mode !== "flip";
    const means_box = this.find("means");
    if (means_box) means_box.checked = means;
    this.find("curve-row").hidden = layer !== "image";
    const amount = this.find("amount"), picture = layer === "image";
    this.find("amount-row").hidden = layer === "flip-map";
    [amount.min, amount.max, amount.value] = picture ? [-12, 12, this.state.stops] : [-2, 8, this.state.gain];
    this.find("amount-name").textContent = picture ? "Exposure" : "Gain";
    this.find("amount-value").textContent = `${signed(picture ? this.state.stops : this.state.gain, 2)} ${picture ? "EV" : ""}`;
    this.find("scale").hidden = picture;
    this.find("scale").innerHTML = layer === "difference" ? this.differenceScale() : this.flipScale();
    this.divider.hidden = mode !== "slider";
    this.divider.style.left = `${100 * split}%`;
    this.divider.setAttribute("aria-valuenow", Math.round(100 * split));
    const names = mode === "flip" ? [shown] : mode === "slider" ? [left, right] : this.pictures.map((_, i) => i);
    this.canvas.setAttribute("aria-label", `${layer}: ${names.map((i) => this.pictures[i].label).join(", ")}`);
  }

  range() {
    return 0.5 / 2 ** this.state.gain;
  }

  differenceScale() {
    const percent = `${Number((100 * this.range()).toPrecision(3))} %`;
    return `<span>−${percent} too dark</span><i style="background:${gradient(this.maps.difference, true)}"></i><span>+${percent} too bright</span>`;
  }

  flipScale() {
    return `<span>FLIP 0</span><i style="background:${gradient(this.maps.magma, false)}"></i><span>1</span>`;
  }

  radianceOf(i) {
    const picture = this.pictures[i];
    return radiance((this.state.means && picture.mean) || picture.image);
  }

  /** A canvas of the image's own size with picture i in the present layer; the reference, which has no error, stays an image. */
  rendered(i) {
    const {stops, gain, curve, means} = this.state, picture = this.pictures[i], layer = picture.graph === null ? "image" : this.state.layer;
    const key = `${i} ${means} ${layer} ${layer === "image" ? `${stops} ${curve}` : layer === "difference" ? gain : ""}`;
    const cached = this.canvases.get(i);
    if (cached?.key === key) return cached.canvas;
    const canvas = cached?.canvas ?? Object.assign(document.createElement("canvas"), {width: this.size[0], height: this.size[1]});
    const context = canvas.getContext("2d"), out = context.createImageData(...this.size);
    const flip = errors((means && picture.mean_flip) || picture.flip);
    if (layer === "image") paintRadiance(out, this.radianceOf(i), stops, curve);
    else if (layer === "difference") paintDifference(out, this.radianceOf(i), this.radianceOf(0), this.range(), this.maps.difference);
    else if (flip) paintErrors(out, flip, this.maps.magma);
    context.putImageData(out, 0, 0);
    this.canvases.set(i, {key, canvas});
    return canvas;
  }

  /** Rectangles of the stage, in its pixels, with the picture that each shows. */
  panes() {
    const {mode, shown, left, right, split} = this.state, {width, height} = this.canvas;
    if (mode === "flip") return [{picture: shown, x: 0, y: 0, width, height, cell: {x: 0, y: 0, width, height}}];
    if (mode === "slider") {
      const at = Math.round(split * width), cell = {x: 0, y: 0, width, height};
      return [{picture: left, x: 0, y: 0, width: at, height, cell}, {picture: right, x: at, y: 0, width: width - at, height, cell}];
    }
    const [columns, rows] = this.grid();
    return this.pictures.map((_, picture) => {
      const cell = {x: (picture % columns) * width / columns, y: Math.floor(picture / columns) * height / rows,
        width: width / columns, height: height / rows};
      return {picture, ...cell, cell};
    });
  }

  /** Columns and rows that make the images largest. */
  grid() {
    const n = this.pictures.length, box = this.stage.clientWidth;
    const columns = Math.max(1, Math.min(n, box < 520 ? 1 : box < 900 ? 2 : n <= 4 && n !== 3 ? 2 : 3));
    return [columns, Math.ceil(n / columns)];
  }

  /** Height of the stage from its width. */
  layout() {
    const ratio = this.size[1] / this.size[0], width = this.stage.clientWidth;
    const [columns, rows] = this.state.mode === "grid" ? this.grid() : [1, 1];
    const height = Math.round(Math.min((width / columns) * ratio * rows, rows > 1 ? 1e5 : 0.82 * window.innerHeight));
    this.stage.style.height = `${Math.max(height, 120)}px`;
    const scale = window.devicePixelRatio || 1;
    const [w, h] = [Math.round(width * scale), Math.round(this.stage.clientHeight * scale)];
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, {width: w, height: h});
  }

  /** Stage pixels a pixel of the image, in a cell. */
  scale(cell) {
    return this.view.zoom * Math.min(cell.width / this.size[0], cell.height / this.size[1]);
  }

  draw() {
    if (this.pending || !this.ready) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = null;
      this.layout();
      this.paint();
    });
  }

  paint() {
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    for (const pane of this.panes()) this.paintPane(context, pane);
    this.find("zoom").textContent = `${Math.round(100 * this.scale(this.panes()[0].cell) / (window.devicePixelRatio || 1))} %`;
    this.stage.dataset.painted = (Number(this.stage.dataset.painted) || 0) + 1;
  }

  paintPane(context, {picture, x, y, width, height, cell}) {
    const scale = this.scale(cell), image = this.rendered(picture);
    context.save();
    context.beginPath();
    context.rect(x, y, width, height);
    context.clip();
    context.imageSmoothingEnabled = scale < 1;
    context.imageSmoothingQuality = "high";
    const left = cell.x + cell.width / 2 - this.view.x * scale, top = cell.y + cell.height / 2 - this.view.y * scale;
    context.drawImage(image, left, top, this.size[0] * scale, this.size[1] * scale);
    this.paintLabel(context, picture, {x, y, width});
    context.restore();
  }

  paintLabel(context, picture, {x, y, width}) {
    const unit = window.devicePixelRatio || 1, right = this.state.mode === "slider" && picture === this.state.right && x > 0;
    const text = `${picture}  ${this.pictures[picture].label}`;
    context.font = `600 ${12 * unit}px system-ui, sans-serif`;
    const wide = context.measureText(text).width + 16 * unit;
    const at = right ? x + width - wide - 8 * unit : x + 8 * unit;
    context.fillStyle = "rgba(12, 14, 18, 0.72)";
    context.beginPath();
    context.roundRect(at, y + 8 * unit, wide, 22 * unit, 5 * unit);
    context.fill();
    context.fillStyle = "#fff";
    context.textBaseline = "middle";
    context.fillText(text, at + 8 * unit, y + 19.5 * unit);
  }

  /** The pixel of the image under a point of the window; null outside. */
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect(), unit = this.canvas.width / box.width;
    const [px, py] = [(event.clientX - box.left) * unit, (event.clientY - box.top) * unit];
    const pane = this.panes().find(({cell: c}) => px >= c.x && px < c.x + c.width && py >= c.y && py < c.y + c.height);
    if (!pane) return null;
    const scale = this.scale(pane.cell);
    const x = (px - pane.cell.x - pane.cell.width / 2) / scale + this.view.x, y = (py - pane.cell.y - pane.cell.height / 2) / scale + this.view.y;
    return {x, y, inside: x >= 0 && y >= 0 && x < this.size[0] && y < this.size[1]};
  }

  /** Values of every picture at a pixel. */
  read(pixel) {
    const out = this.find("readout");
    if (!pixel?.inside) return;
    const [x, y] = [Math.floor(pixel.x), Math.floor(pixel.y)], i = y * this.size[0] + x;
    const rows = this.pictures.map((picture, k) => {
      const pixels = this.radianceOf(k), rgb = [0, 1, 2].map((c) => digits(pixels[3 * i + c]));
      const off = picture.graph === null ? "" : `${signed(100 * relativeDifference(pixels, this.radianceOf(0), i), 1)} %`;
      return `<tr><th scope="row">${k} ${escaped(picture.label)}</th>${rgb.map((v) => `<td>${v}</td>`).join("")}<td>${off}</td></tr>`;
    });
    out.querySelector("caption").textContent = `Pixel ${x}, ${y}`;
    out.querySelector("tbody").innerHTML = rows.join("");
  }

  zoomBy(factor, about) {
    const zoom = Math.min(Math.max(this.view.zoom * factor, 1), 64);
    if (about) {
      const keep = 1 - this.view.zoom / zoom;
      this.view.x += (about.x - this.view.x) * keep;
      this.view.y += (about.y - this.view.y) * keep;
    }
    this.view.zoom = zoom;
    this.panBy(0, 0);
  }

  /** Moves by pixels of the image; the image stays in the middle. */
  panBy(x, y) {
    const {zoom} = this.view, [w, h] = this.size;
    const within = (value, side) => Math.min(Math.max(value, side / 2 / zoom), side - side / 2 / zoom);
    this.view.x = within(this.view.x + x, w);
    this.view.y = within(this.view.y + y, h);
    this.draw();
  }

  fit() {
    this.view = {zoom: 1, x: this.size[0] / 2, y: this.size[1] / 2};
    this.draw();
  }

  choose(i) {
    if (i >= this.pictures.length) return;
    if (this.state.mode === "slider") this.set({right: i});
    else this.set({mode: "flip", shown: i});
  }

  /** A key of the keyboard; true when it meant something. */
  key(event) {
    const {key} = event, step = this.size[0] / this.view.zoom / 20;
    if (/^[0-9]$/.test(key)) this.choose(Number(key));
    else if (key === "f" || key === "s" || key === "g") this.set({mode: MODES["fsg".indexOf(key)]});
    else if (key === "i" || key === "d" || key === "p") this.set({layer: LAYERS["idp".indexOf(key)]});
    else if (key === "[" || key === "]") this.amount((key === "]" ? 1 : -1) * 0.25);
    else if (key === "+" || key === "=") this.zoomBy(1.5);
    else if (key === "-") this.zoomBy(1 / 1.5);
    else if (key === "r") this.fit();
    else if (key.startsWith("Arrow") && document.activeElement === this.canvas) {
      this.panBy(step * ((key === "ArrowRight") - (key === "ArrowLeft")), step * ((key === "ArrowDown") - (key === "ArrowUp")));
    } else return false;
    return true;
  }

  amount(change) {
    const key = this.state.layer === "image" ? "stops" : "gain", box = this.find("amount");
    this.set({[key]: Math.min(Math.max(this.state[key] + change, Number(box.min)), Number(box.max))});
  }

  bind() {
    this.root.addEventListener("click", (event) => {
      const button = event.target.closest("button[data-set], button[data-do]");
      if (!button) return;
      const [key, value] = (button.dataset.set ?? "").split("=");
      if (button.dataset.do) this[button.dataset.do](Number(button.dataset.with));
      else this.set({[key]: key === "shown" ? Number(value) : value});
    });
    this.find("curve").addEventListener("change", (event) => this.set({curve: event.target.value}));
    this.find("left").addEventListener("change", (event) => this.set({left: Number(event.target.value)}));
    this.find("right").addEventListener("change", (event) => this.set({right: Number(event.target.value)}));
    this.find("means")?.addEventListener("change", (event) => this.set({means: event.target.checked}));
    this.find("amount").addEventListener("input", (event) => {
      this.set({[this.state.layer === "image" ? "stops" : "gain"]: Number(event.target.value)});
    });
    this.bindPointer();
    this.bindDivider();
  }

  bindPointer() {
    const pointers = new Map();
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      this.read(this.pixelAt(event));
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const scale = this.scale(this.panes()[0].cell) / (this.canvas.width / this.canvas.clientWidth);
      if (pointers.size === 1) this.panBy((before.clientX - event.clientX) / scale, (before.clientY - event.clientY) / scale);
      else this.pinch([...pointers.values()], event);
      pointers.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    this.canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;
      event.preventDefault();
      this.zoomBy(2 ** (-event.deltaY / 240), this.pixelAt(event));
    }, {passive: false});
    this.canvas.addEventListener("dblclick", (event) => this.zoomBy(2, this.pixelAt(event)));
  }

  /** Two fingers: `before` where they were, `moved` the one that moves. */
  pinch(before, moved) {
    const other = before.find((event) => event.pointerId !== moved.pointerId), mine = before.find((event) => event.pointerId === moved.pointerId);
    const apart = (a, b) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    this.zoomBy(apart(moved, other) / Math.max(apart(mine, other), 1), this.pixelAt(other));
  }

  bindDivider() {
    const to = (event) => {
      const box = this.stage.getBoundingClientRect();
      this.set({split: Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1)});
    };
    this.divider.addEventListener("pointerdown", (event) => {
      this.divider.setPointerCapture(event.pointerId);
      this.divider.focus();
      event.preventDefault();
    });
    this.divider.addEventListener("pointermove", (event) => {
      if (this.divider.hasPointerCapture(event.pointerId)) to(event);
    });
    this.divider.addEventListener("keydown", (event) => {
      const places = {ArrowLeft: this.state.split - 0.02, ArrowRight: this.state.split + 0.02, Home: 0, End: 1};
      if (!(event.key in places)) return;
      event.preventDefault();
      event.stopPropagation();
      this.set({split: Math.min(Math.max(places[event.key], 0), 1)});
    });
  }
}
