// Stands last in the page under test, handles it as a reader would, and writes what it saw into the page as JSON.
addEventListener("load", async () => {
  const pause = () => new Promise((resolve) => setTimeout(resolve, 100));
  const figures = [...document.querySelectorAll("figure.plot")].filter((figure) => figure.querySelector("script"));

  // Pixels with a colour: axes and grid are grey, so what is counted is curves.
  function ink(canvas) {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      if (data[i + 3] > 128 && Math.max(r, g, b) - Math.min(r, g, b) > 60) count += 1;
    }
    return count;
  }

  const visible = (selector) => figures.filter((figure) => figure.querySelector(selector)?.checkVisibility()).length;
  const spoken = () => figures.filter((figure) => /\d/.test(figure.querySelector(".at")?.textContent ?? "")).length;
  await pause();
  const report = {
    title: document.title,
    plots: figures.map((figure) => ({ title: figure.querySelector("h3").textContent, ink: [...figure.querySelectorAll("canvas")].map(ink) })),
    overflow: document.documentElement.scrollWidth - innerWidth,
    background: getComputedStyle(document.body).backgroundColor,
    width: innerWidth,
    excuses: visible(".undrawn"),
  };

  const over = document.querySelector(".u-over");
  if (over) {
    const box = over.getBoundingClientRect();
    const mouse = (target, type, part) => target.dispatchEvent(new MouseEvent(type, {
      bubbles: true, button: 0, movementX: 1, clientX: box.left + part * box.width, clientY: box.top + box.height / 2,
    }));
    mouse(over, "mouseenter", 0.3);
    mouse(over, "mousemove", 0.3);
    await pause();
    report.reading = spoken();
    mouse(over, "mousedown", 0.3);
    mouse(over, "mousemove", 0.6);
    mouse(document, "mouseup", 0.6);
    await pause();
    report.zoomed = visible(".reset");
    report.ink_zoomed = ink(document.querySelector("canvas"));
    mouse(over, "dblclick", 0.5);
    await pause();
    report.zoomed_after_double_click = visible(".reset");
    document.querySelector(".legend button").click();
    await pause();
    report.ink_hidden = ink(document.querySelector("canvas"));
  }
  Object.assign(report, window.noted, { loads: performance.getEntriesByType("resource").map((entry) => entry.name) });
  const place = document.createElement("pre");
  place.id = "probe";
  place.textContent = JSON.stringify(report).replace(/[<>&\u0080-\uffff]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);
  document.body.append(place);
});
