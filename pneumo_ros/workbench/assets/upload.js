// Files and folders dropped on the page, or chosen, go to the server one by one; then the page lists them.
"use strict";
(() => {
  const desk = () => location.pathname.split("/").pop();
  const say = (text) => window.dash_clientside.set_props("upload-says", { children: text });

  // All files below an entry, each with its path.
  async function files(entry, above = "") {
    if (entry.isFile) {
      const file = await new Promise((done, fail) => entry.file(done, fail));
      return [[above + entry.name, file]];
    }
    const reader = entry.createReader();
    const found = [];
    for (;;) {
      const some = await new Promise((done, fail) => reader.readEntries(done, fail));
      if (!some.length) return found;
      for (const inner of some) found.push(...(await files(inner, `${above}${entry.name}/`)));
    }
  }

  async function send(list) {
    const problems = [];
    for (const [k, [path, file]] of list.entries()) {
      say(`Taking ${k + 1} of ${list.length}: ${path}`);
      const where = `/upload/${desk()}/${path.split("/").map(encodeURIComponent).join("/")}`;
      try {
        const answer = await fetch(where, { method: "PUT", body: file });
        if (answer.status === 413) problems.push(`${path} is too large`);
        else if (!answer.ok) problems.push(await answer.text());
      } catch (error) {
        problems.push(`${path}: ${error.message}`);
      }
    }
    say(problems.join(". "));
    window.dash_clientside.set_props("uploaded", { data: Date.now() });
  }

  const inside = (event) => event.target.closest && event.target.closest("#drop");
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    const place = document.getElementById("drop");
    if (place) place.classList.toggle("over", Boolean(inside(event)));
  });
  document.addEventListener("drop", async (event) => {
    event.preventDefault(); // a file dropped elsewhere must not replace the page
    document.getElementById("drop").classList.remove("over");
    if (!inside(event)) return;
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
    const found = [];
    for (const entry of entries) found.push(...(await files(entry)));
    await send(found);
  });
  document.addEventListener("click", (event) => {
    const button = event.target.closest && event.target.closest("[data-choose]");
    if (!button) return;
    const input = document.createElement("input");
    input.type = "file";
    input.multiple = true;
    input.webkitdirectory = button.dataset.choose === "folder";
    input.onchange = () => send([...input.files].map((file) => [file.webkitRelativePath || file.name, file]));
    input.click();
  });
})();
