"use strict";
// What people may order, and the answers: an order is accepted only with a plan that is proven to keep all promises.

const SENT = 2000; // ms for which a button that was pressed does nothing: a second press would be a second order

function setOrders() {
  const robots = scene.agents.filter(({ kind }) => kind === "robot");
  $("service").hidden = robots.length === 0;
  say($("within-unit"), scene.counts);
  $("written").placeholder = example();
  $("order-buttons").replaceChildren(...scene.orders.map(({ word, label }) => {
    const button = make("button", "order", label);
    button.type = "button";
    button.dataset.word = word;
    onPress(button, () => send(button, inTime(word)));
    return button;
  }));
  $("service-buttons").replaceChildren(...robots.map(({ name }) => serviceButton(name)));
}

function serviceButton(robot) {
  const button = make("button", "service");
  button.type = "button";
  button.dataset.robot = robot;
  onPress(button, () => send(button, `${isOut(robot) ? "join" : "leave"} ${robot}`));
  return button;
}

function isOut(robot) {
  return view.out_of_service.includes(robot);
}

function example() { // what one may write, with names of this scenario
  const robot = scene.agents.find((agent) => agent.kind === "robot"), places = Object.keys(scene.places);
  return robot && places.length ? `${robot.name} at ${places[places.length - 1]}` : "";
}

function inTime(word) { // with the time that stands in the field
  const within = $("within").value.trim();
  return within === "" || / within /.test(word) ? word : `${word} within ${within}`;
}

onPress($("write"), () => { if ($("written").value.trim()) send($("write"), inTime($("written").value.trim())); });

function send(button, word) {
  ask({ do: "order", word, seq: view.seq });
  button.dataset.sent = "true";
  setTimeout(() => { delete button.dataset.sent; refresh(); }, SENT);
  refresh();
}

function showOrders(here) {
  for (const button of [$("write"), ...$("order-buttons").children]) {
    enable(button, here && view.status === "running" && button.dataset.sent !== "true" && $("within").checkValidity());
  }
  for (const button of $("service-buttons").children) {
    say(button, `${isOut(button.dataset.robot) ? "Bring back" : "Take out"} ${shown(button.dataset.robot)}`);
  }
  for (const button of document.querySelectorAll("#answers button, #service-buttons button")) {
    enable(button, here && view.status === "running" && button.dataset.sent !== "true");
  }
  const known = JSON.stringify(view.ordered);
  if ($("answers").dataset.known === known) return;
  $("answers").dataset.known = known;
  $("answers").replaceChildren(...view.ordered.map(({ at, order, accepted, text }) => {
    const line = make("li", accepted ? "good" : "bad");
    line.append(make("span", "at", units(at)), make("span", "", `${shown(order)}: ${text}`));
    if (accepted && !/^(cancel|leave|join) /.test(order)) {
      const button = make("button", "small", "Cancel"), word = order.replace(/^urgent /, "").replace(/ within .*$/, "");
      button.type = "button";
      onPress(button, () => send(button, `cancel ${word}`));
      line.append(button);
    }
    return line;
  }));
}
