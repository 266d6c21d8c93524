"use strict";
// Whether what the page shows is of now: its connection to the UI, and the UI's connection to the observer.

const QUIET = 3000; // ms without a message after which the page asks whether the UI is there
const DEAF = 6000; // ms without an answer after which it connects anew: a phone that slept keeps a dead connection
let socket = null;
let received = Date.now(); // when the last message came; a clock that runs on while a phone sleeps
let patience = 1000; // ms until the next try to connect
let refused = ""; // why the UI does not let this page in
let farewell = ""; // why the UI has closed the page

const isConnected = () => socket !== null && socket.readyState === WebSocket.OPEN;
const isCurrent = () => isConnected() && (!view || view.answers); // what is shown is of now, and can be acted on
const clockTime = (moment) => new Date(moment).toLocaleTimeString("en-GB"); // HH:MM:SS

function connect() {
  const address = (location.protocol === "https:" ? "wss://" : "ws://") + location.host + "/live";
  const made = new WebSocket(address);
  let opened = false;
  socket = made;
  made.onopen = () => { opened = true; refused = farewell = ""; patience = 1000; received = Date.now(); };
  made.onmessage = (event) => { received = Date.now(); take(JSON.parse(event.data)); };
  made.onclose = (event) => {
    if (event.code === 1000) farewell = event.reason;
    if (!opened) explain();
    disconnected(patience);
    patience = Math.min(2 * patience, 5000);
  };
}

function disconnected(wait) { // what is shown is old from here on
  socket = null;
  if (view) clock = { now: present(), seen: performance.now(), rate: 0 };
  showConnection();
  refresh();
  setTimeout(connect, wait);
}

function checkConnection() {
  if (!isConnected()) return;
  const silent = Date.now() - received;
  if (silent > DEAF) {
    const old = socket;
    old.onopen = old.onmessage = old.onclose = null;
    old.close();
    disconnected(0);
  } else if (silent > QUIET) socket.send("alive?");
}

async function explain() { // a WebSocket does not say why it was refused
  try {
    const answer = await fetch("page.css", { cache: "no-store" });
    refused = answer.status === 401 || answer.status === 403 ? "not allowed: open the link that the UI has printed" : "";
    showConnection();
  } catch (problem) { /* there is nobody */ }
}

function showConnection() {
  const old = (moment) => (view ? `; this is as of ${clockTime(moment)}` : "");
  let text = "connected";
  if (!isConnected()) text = (view && view.verdict && farewell) || refused || `connection lost, trying again${old(received)}`;
  else if (view && !view.answers) text = `the observer does not answer${old(1000 * view.received)}`;
  $("link").dataset.is = isCurrent() ? "here" : "away";
  say($("link"), text);
}

setInterval(checkConnection, 500);
document.addEventListener("visibilitychange", checkConnection);
