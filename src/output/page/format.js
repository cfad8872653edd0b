"use strict";

// What went wrong is said on the page: nobody looks at the console.
function complain(what) {
  const box = document.getElementById("problems");
  box.textContent += `${box.textContent ? " " : "Something on this page does not work: "}${what}.`;
  box.hidden = false;
}
window.addEventListener("error", (event) => complain(event.message));
window.addEventListener("securitypolicyviolation", (event) => complain(`refused: ${event.violatedDirective}`));
window.addEventListener("unhandledrejection", (event) => complain(String(event.reason)));

const byId = (id) => document.getElementById(id);

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function svgElement(name, attributes = {}, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

const superscript = (n) => String(n).replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"["0123456789-".indexOf(c)]);
const minus = (text) => text.replace("-", "−");

// A number for reading: significant digits, powers of ten only where zeros would pile up.
function readable(value, digits = 4) {
  if (value === null || !Number.isFinite(value)) return "no number";
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-3 && size < 1e6)) return minus(String(Number(value.toPrecision(digits))));
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${minus(String(Number(mantissa)))}×10${superscript(Number(exponent))}`;
}

const prefixes = { "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };
const prefixed = new Set(["s", "m", "J", "N", "Pa", "N/m", "m/s", "rad/s"]);
const unitNames = { 1: "", R_min: "Rₘᵢₙ" };

// Factor and unit in which numbers up to `largest` are short: 0.0031 m are 3.1 mm.
function unitFor(unit, largest) {
  const name = unitNames[unit] ?? unit;
  if (!(largest > 0) || (largest >= 0.1 && largest < 1e4)) return { factor: 1, name };
  const exponent = Math.floor(Math.log10(largest) / 3 + 1e-9) * 3;
  const factor = 10 ** -exponent;
  if (prefixed.has(unit) && exponent in prefixes) return { factor, name: prefixes[exponent] + name };
  return { factor, name: `10${superscript(exponent)}${name ? " " + name : ""}` };
}

// The smallest of 1, 2, 5 times a power of ten that makes at most `most` steps of a range.
function roundStep(range, most) {
  const power = 10 ** Math.floor(Math.log10(range / most));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => range / step <= most * (1 + 1e-9));
}

function ticks(low, high, most) {
  const step = roundStep(high - low, most);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++)
    found.push({ value: n * step, label: minus((n * step).toFixed(decimals)) });
  return found;
}
