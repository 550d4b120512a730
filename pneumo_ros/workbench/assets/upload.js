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

  const TABLE = /\.(csv|tsv|txt|dat|exp|asc|log|mat|npz|npy|parquet|pq|json|jsonl|ndjson)(\.gz)?$/i;
  const folders = { table: "tables_to_import", machine: "machine_files" };

  // `what` is "table" or "machine" for files that are no recordings.
  async function send(list, what) {
    const problems = [];
    let taken = "";
    for (const [k, [given, file]] of list.entries()) {
      const kind = what || (TABLE.test(given) && !given.includes("/") ? "table" : "");
      const path = kind ? `${folders[kind]}/${file.name}` : given;
      say(`Taking ${k + 1} of ${list.length}: ${path}`);
      const where = `/upload/${desk()}/${path.split("/").map(encodeURIComponent).join("/")}`;
      try {
        const answer = await fetch(where, { method: "PUT", body: file });
        if (answer.status === 413) problems.push(`${path} is too large`);
        else if (!answer.ok) problems.push(await answer.text());
        else if (kind) window.dash_clientside.set_props(`${kind}-uploaded`, { data: { name: (taken = file.name), at: Date.now() } });
      } catch (error) {
        problems.push(`${path}: ${error.message}`);
      }
    }
    say(problems.join(". "));
    if (what) window.dash_clientside.set_props(`${what}-says`, { children: problems.join(". ") || taken });
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
    const what = button.dataset.choose in folders ? button.dataset.choose : "";
    input.multiple = !what;
    input.webkitdirectory = button.dataset.choose === "folder";
    input.onchange = () => send([...input.files].map((file) => [file.webkitRelativePath || file.name, file]), what);
    input.click();
  });
})();
