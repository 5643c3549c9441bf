/** Before the first paint: the theme chosen on an earlier visit. A classic script, on purpose. */
try {
  const theme = localStorage.getItem("deltaviz-theme");
  if (theme === "light" || theme === "dark") document.documentElement.dataset["theme"] = theme;
} catch {
  // A browser may forbid storage; the page then follows the system.
}
