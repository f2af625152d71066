"use strict";
// Shows texts, which the researcher can change: as much of Markdown as a consent form needs, and no
// markup of their own. # headings, lists with - or 1., paragraphs, **bold**, *italics*, `keys`,
// [words](https://address); {names} stand for values that are known only when a text is shown.

const texts = JSON.parse(byId("texts").textContent);

function textOf(key, values = {}) {
  return texts[key].replace(/\{(\w+)\}/g, (all, name) => name in values ? values[name] : all);
}

// Puts a text in an element: as words in a line, or as paragraphs and lists.
const putText = (element, key, values) => element.replaceChildren(...inlineOf(textOf(key, values)));
const putTexts = (element, key, values) => element.replaceChildren(...elementsOf(textOf(key, values)));

function putAllTexts() {
  document.documentElement.lang = texts.language;
  for (const element of document.querySelectorAll("[data-text]")) putText(element, element.dataset.text);
  for (const element of document.querySelectorAll("[data-texts]")) putTexts(element, element.dataset.texts);
  for (const element of document.querySelectorAll("[data-label]")) element.setAttribute("aria-label", textOf(element.dataset.label));
}

function inlineOf(text) {
  const parts = text.split(/(\*\*[^*]+\*\*|\*[^*]+\*|`[^`]+`|\[[^\]]+\]\((?:https?:|mailto:)[^)\s]+\))/);
  return parts.filter(p => p).map(part => {
    const link = part.match(/^\[([^\]]+)\]\((.+)\)$/);
    if (link) return make("a", {href: link[2], target: "_blank", rel: "noreferrer"}, link[1]);
    if (part.startsWith("**") && part.length > 4) return make("b", {}, part.slice(2, -2));
    if (part.startsWith("*") && part.length > 2) return make("i", {}, part.slice(1, -1));
    if (part.startsWith("`") && part.length > 2) return make("kbd", {}, part.slice(1, -1));
    return part;
  });
}

// Returns the elements of a text. Paragraphs end where a line is empty, or where something else begins.
function elementsOf(text) {
  const elements = [];
  let open = null;  // the paragraph or list that goes on in the next line
  for (const line of text.split(/\r?\n/)) {
    const [, sharps, heading] = line.match(/^(#{1,3})\s+(.*)/) || [];
    const [, bullet, item] = line.match(/^\s*(-|\*|\d+\.)\s+(.*)/) || [];
    const tag = heading ? "h" + sharps.length : item ? (/\d/.test(bullet) ? "ol" : "ul") : "p";
    if (!line.trim()) { open = null; continue; }
    if (heading || !open || (item ? open.localName !== tag : false)) elements.push(open = make(tag));
    if (item) open.append(make("li", {}, ...inlineOf(item)));
    else if (open.lastElementChild?.localName === "li") open.lastElementChild.append(" ", ...inlineOf(line.trim()));
    else open.append(open.textContent ? " " : "", ...inlineOf(heading || line.trim()));
    if (heading) open = null;
  }
  return elements;
}
