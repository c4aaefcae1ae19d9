// Stands first in the page under test and notes whatever goes wrong in it.
window.noted = { errors: [], violations: [] };
addEventListener("error", (event) => window.noted.errors.push(String(event.message ?? event.target.outerHTML)), true);
addEventListener("unhandledrejection", (event) => window.noted.errors.push(String(event.reason)));
document.addEventListener("securitypolicyviolation", (event) => window.noted.violations.push(`${event.violatedDirective} ${event.blockedURI}`));
for (const level of ["error", "warn"]) {
  const write = console[level];
  console[level] = (...words) => { window.noted.errors.push(words.join(" ")); write.apply(console, words); };
}
