"use strict";
// What people may order, and the answers: an order is accepted only with a plan that is proven to keep all promises.

const SENT = 2000; // ms for which a button that was pressed does nothing: a second press would be a second order

function setOrders() {
  $("menu").hidden = scene.orders.length === 0;
  say($("within-unit"), scene.counts);
  $("order-buttons").replaceChildren(...scene.orders.map(({ word, label }) => {
    const button = make("button", "order", label);
    button.type = "button";
    button.dataset.word = word;
    onPress(button, () => {
      const within = $("within").value.trim();
      send(button, within === "" ? word : `${word} within ${within}`);
    });
    return button;
  }));
}

function send(button, word) {
  ask({ do: "order", word, seq: view.seq });
  button.dataset.sent = "true";
  setTimeout(() => { delete button.dataset.sent; refresh(); }, SENT);
  refresh();
}

function showOrders(here) {
  for (const button of $("order-buttons").children) {
    enable(button, here && view.status === "running" && button.dataset.sent !== "true" && $("within").checkValidity());
  }
  for (const button of document.querySelectorAll("#answers button")) {
    enable(button, here && view.status === "running" && button.dataset.sent !== "true");
  }
  const known = JSON.stringify(view.ordered);
  if ($("answers").dataset.known === known) return;
  $("answers").dataset.known = known;
  $("answers").replaceChildren(...view.ordered.map(({ at, order, accepted, text }) => {
    const line = make("li", accepted ? "good" : "bad");
    line.append(make("span", "at", units(at)), make("span", "", `${shown(order)}: ${text}`));
    if (accepted && !order.startsWith("cancel ")) {
      const button = make("button", "small", "Cancel"), word = order.replace(/^urgent /, "").split(" ")[0];
      button.type = "button";
      onPress(button, () => send(button, `cancel ${word}`));
      line.append(button);
    }
    return line;
  }));
}
