// Theme, printing, links, and the initial view.

(() => {
  const button = squama.at("theme"), root = document.documentElement;
  const setTheme = (dark) => {
    root.dataset.theme = dark ? "dark" : "light";
    button.setAttribute("aria-pressed", String(dark));
    button.textContent = dark ? "Light" : "Dark";
  };
  const isDark = () => root.dataset.theme === "dark";
  button.addEventListener("click", () => setTheme(!isDark()));

  // A print has the light theme and all charts.
  let before = null;
  addEventListener("beforeprint", () => {
    before = isDark();
    setTheme(false);
    squama.drawAll();
  });
  addEventListener("afterprint", () => setTheme(before));

  // Links within the page must not change the address, which contains the state of the page.
  document.querySelectorAll('a[href^="#"]').forEach((link) => link.addEventListener("click", (event) => {
    event.preventDefault();
    const target = squama.at(link.getAttribute("href").slice(1));
    target.scrollIntoView();
    target.tabIndex = -1;
    target.focus({ preventScroll: true });
  }));
  const share = squama.at("share");
  share.addEventListener("click", async () => {
    const address = `${location.href.split("#")[0]}#${squama.written()}`;
    try { await navigator.clipboard.writeText(address); share.textContent = "Copied"; }
    catch { prompt("The address of this view", address); }
    setTimeout(() => { share.textContent = "Copy link"; }, 1500);
  });

  const asked = location.hash.includes("=") ? location.hash.slice(1) : squama.opening;
  squama.read(asked);
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
  squama.showAll();
  squama.setFolded(true);
})();
