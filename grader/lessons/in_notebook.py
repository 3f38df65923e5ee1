"""What a notebook shows as a widget, and as text where there are no widgets."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from typing import Any


class InNotebook(ABC):
    """An object that a cell shows: its widget, or what `repr` says."""

    def _ipython_display_(self) -> None:
        from IPython.display import display

        if (box := self._widget()) is None:
            print(self)
        else:
            display(box)

    def _widget(self) -> Any:
        """Return the widget; None where there are no widgets."""
        try:
            widgets = importlib.import_module("ipywidgets")
        except ModuleNotFoundError:
            return None
        return self._made_of(widgets)

    @abstractmethod
    def _made_of(self, widgets: Any) -> Any:
        """Return the widget, made of parts of the module `ipywidgets`."""
