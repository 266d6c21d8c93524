"""How a robot checks, keeps and exchanges the missions that it has received."""
